// Possible faults of a camera that all pairs of a set share, and how each displaces the key points.
#pragma once

#include <Eigen/Core>
#include <array>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"
#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"

namespace rcme {

// The last four are never named. They serve to detect that the others do not explain the residuals.
enum class CameraFault {
  kFocalLength,
  kPrincipalPointX,
  kPrincipalPointY,
  kDistortion,
  kReadoutTime,
  kImage2ShiftX,
  kImage2ShiftY,
  kAspectRatio,
  kDistortionK2,
  kTangentialX,
  kTangentialY
};
inline constexpr std::array kCameraFaults = {
    CameraFault::kFocalLength,  CameraFault::kPrincipalPointX, CameraFault::kPrincipalPointY,
    CameraFault::kDistortion,   CameraFault::kReadoutTime,     CameraFault::kImage2ShiftX,
    CameraFault::kImage2ShiftY, CameraFault::kAspectRatio,     CameraFault::kDistortionK2,
    CameraFault::kTangentialX,  CameraFault::kTangentialY};
inline constexpr int kNumCameraFaults = static_cast<int>(kCameraFaults.size());
inline constexpr int kNumNamedFaults = 7;

struct CameraFaultText {
  const char* name;         // in files
  const char* words;        // for people
  const char* unit;         // "%", "px", ""
  double per_unit;          // 100 where the unit is per cent
  double nominal;           // smaller faults do not matter
  const char *more, *less;  // words for a positive and a negative fault
};
const CameraFaultText& FindFaultText(CameraFault fault);

// The greatest plausible size of a fault, of either sign, for a camera that has been calibrated: focal length
// 50 %, principal point a quarter of the image, readout the whole time between the images, shift of image 2
// 10 px, all others (k1 among them) 0.5.
double GreatestFault(CameraFault fault, const Camera& camera);

using ShiftsByFaults = Eigen::Matrix<double, 4, kNumCameraFaults>;

// d [x1; x2] / d theta of the observed match, px, at theta = 0. Columns in the order of kCameraFaults:
//
//   focal length      assumed f = true f (1 + theta):           -(x - c)
//   principal point   assumed c = true c + theta, px:           -1 along x, along y
//   distortion k1     imaged at (1 + theta |ray|^2) ray:         |ray|^2 (x - c)
//   readout time      row y is read later than the middle row by the share theta ((y + 1/2) / height - 1/2)
//                     of the time between the images:          (y + 1/2) / height - 1/2 times v, the velocity
//                     of the point's image
//   image 2           its key points shifted by theta, px:      1 along x, along y, in image 2 only
//   aspect ratio      assumed fy = true fy (1 + theta), k2: |ray|^4 (x - c), tangential:
//                     f (r^2 + 2 rx^2, 2 rx ry) and f (2 rx ry, r^2 + 2 ry^2), r = (rx, ry) the ray
//
// The readout assumes a motion whose rotation vector w and translation t grow evenly in time: v_1 is the
// image of w x X_1 + t and v_2 that of w x (X_2 - t) + t, where X is the point triangulated from the match
// with `cam2_from_cam1` (baseline 1). The models are those of simulator/calibration_error.h and
// camera_defects.h.
ShiftsByFaults ComputeShifts(const Camera& camera1, const Camera& camera2, const RelativePose& cam2_from_cam1,
                             const Correspondence& match);

using FaultVector = Eigen::Matrix<double, kNumCameraFaults, 1>;

// Corrects the cameras for faults of the intrinsics and the key points for the others. The readout is
// corrected for the motion `cam2_from_cam1`. Faults that are never named are ignored.
MotionProblem RemoveFaults(MotionProblem problem, const RelativePose& cam2_from_cam1,
                           const FaultVector& faults);
// The inverse of RemoveFaults, except that it ignores the readout time: the true motion is not known.
MotionProblem PlantFaults(MotionProblem problem, const FaultVector& faults);

}  // namespace rcme
