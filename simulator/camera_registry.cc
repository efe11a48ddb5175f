#include "simulator/camera_registry.h"

#include "simulator/cameras/camera_models.h"

namespace rcme {

const std::vector<CameraEntry>& CameraRegistry() {
  static const std::vector<CameraEntry> registry = {
      {"pinhole", "two equal ideal cameras", MakePinhole},
      {"two_pinholes", "two different ideal cameras", MakeTwoPinholes},
      {"own_intrinsics", "two ideal cameras with size, fx, fy, cx, cy of each", MakeOwnIntrinsics},
      {"radtan", "two equal cameras with OpenCV's radial and tangential distortion", MakeRadtan},
      {"fisheye", "two equal cameras with OpenCV's fisheye model", MakeFisheye},
      {"kitti", "KITTI odometry, rectified grey camera, 1241 x 376, f 719 px", MakeKitti},
      {"euroc", "EuRoC MAV cam0, undistorted, 752 x 480, f 458 px", MakeEuroc},
      {"office", "RGB-D camera of an office robot, 640 x 480, f 525 px", MakeOffice},
      {"euroc_and_office", "euroc for image 1, office for image 2", MakeEurocAndOffice},
  };
  return registry;
}

}  // namespace rcme
