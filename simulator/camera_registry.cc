#include "simulator/camera_registry.h"

#include "simulator/cameras/camera_models.h"

namespace rcme {

const std::vector<CameraEntry>& CameraRegistry() {
  static const std::vector<CameraEntry> registry = {
      {"pinhole", "two equal ideal cameras, any size and focal length", MakePinhole},
      {"two_pinholes", "two different ideal cameras, each with its own size and focal length",
       MakeTwoPinholes},
      {"own_intrinsics", "two user-defined cameras: size, fx, fy, cx, cy of each", MakeOwnIntrinsics},
      {"radtan", "two equal cameras with the radial and tangential distortion of OpenCV's model", MakeRadtan},
      {"fisheye", "two equal fisheye cameras: OpenCV's equidistant model", MakeFisheye},
      {"kitti", "KITTI odometry, rectified grey camera, 1241 x 376, f 719 px", MakeKitti},
      {"euroc", "EuRoC MAV cam0, undistorted, 752 x 480, f 458 px", MakeEuroc},
      {"office", "RGB-D camera of an office robot, 640 x 480, f 525 px", MakeOffice},
      {"euroc_and_office",
       "two real cameras in one pair: EuRoC's for image 1, the office robot's for image 2",
       MakeEurocAndOffice},
  };
  return registry;
}

}  // namespace rcme
