#include "simulator/cameras/camera_models.h"

namespace rcme {
namespace {

// KITTI odometry, sequences 00-02, left grey camera (P0 of calib.txt), rectified: 1241 x 376.
const Camera kKitti = {718.856, 718.856, 607.1928, 185.2157, 1241, 376};
// EuRoC MAV, cam0 (sensor.yaml), undistorted with the same intrinsics: 752 x 480.
const Camera kEuroc = {458.654, 457.296, 367.215, 248.375, 752, 480};
// An RGB-D camera of an office robot: the Kinect's nominal 640 x 480 calibration (ROS openni_camera's
// default).
const Camera kOffice = {525.0, 525.0, 319.5, 239.5, 640, 480};

class FixedCameras : public CameraModel {
 public:
  FixedCameras(const Camera& camera1, const Camera& camera2) : cameras_(camera1, camera2) {}
  std::pair<SceneCamera, SceneCamera> Make() const override { return cameras_; }

 private:
  std::pair<SceneCamera, SceneCamera> cameras_;
};

}  // namespace

std::unique_ptr<CameraModel> MakeKitti() { return std::make_unique<FixedCameras>(kKitti, kKitti); }
std::unique_ptr<CameraModel> MakeEuroc() { return std::make_unique<FixedCameras>(kEuroc, kEuroc); }
std::unique_ptr<CameraModel> MakeOffice() { return std::make_unique<FixedCameras>(kOffice, kOffice); }
std::unique_ptr<CameraModel> MakeEurocAndOffice() { return std::make_unique<FixedCameras>(kEuroc, kOffice); }

}  // namespace rcme
