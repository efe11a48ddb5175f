// What may be wrong with a camera that all pairs of a set share, and how it moves the key points.
#pragma once

#include <Eigen/Core>
#include <array>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"
#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"

namespace rcme {

// The last four are never named: residuals that they explain are not explained by the others.
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
  double nominal;           // a fault of less is none that matters
  const char *more, *less;  // what a positive and a negative one is
};
const CameraFaultText& FindFaultText(CameraFault fault);

// The greatest fault, either way, that a camera that somebody calibrated may have: half of the range of what
// is physically possible. Focal length 50 %, principal point a quarter of the image, k1 0.5, a readout of the
// time between the images, key points of one image 10 px.
double GreatestFault(CameraFault fault, const Camera& camera);

using ShiftsByFaults = Eigen::Matrix<double, 4, kNumCameraFaults>;

// d [x1; x2] / d theta, px, of what is observed, at theta = 0; the columns in the order of kCameraFaults:
//
//   focal length      assumed f = true f (1 + theta):           -(x - c)
//   principal point   assumed c = true c + theta, px:           -1 along x, along y
//   distortion k1     imaged at (1 + theta |ray|^2) ray:         |ray|^2 (x - c)
//   readout time      row y is read theta ((y + 1/2) / height - 1/2) of the time between the images later
//                     than the middle one: that share times v, the velocity of the point's image.
//   image 2           its key points shifted by theta, px:      1 along x, along y, of image 2 alone
//   aspect ratio      assumed fy = true fy (1 + theta), k2: |ray|^4 (x - c), tangential:
//                     f (r^2 + 2 rx^2, 2 rx ry) and f (2 rx ry, r^2 + 2 ry^2), r = (rx, ry) the ray
//
// That of the readout is of a motion whose rotation vector w and translation t grow evenly in time: v_1 is
// the image of w x X_1 + t and v_2 that of w x (X_2 - t) + t, X the point at the depth that the motion
// `cam2_from_cam1` gives the match (baseline 1). These are the models of simulator/calibration_error.h and
// camera_defects.h.
ShiftsByFaults ComputeShifts(const Camera& camera1, const Camera& camera2, const RelativePose& cam2_from_cam1,
                             const Correspondence& match);

using FaultVector = Eigen::Matrix<double, kNumCameraFaults, 1>;

// The problem as it would be without the faults: the cameras without those of the intrinsics, the key points
// without the others, the readout along `cam2_from_cam1`. Faults that are never named do not count.
MotionProblem RemoveFaults(MotionProblem problem, const RelativePose& cam2_from_cam1,
                           const FaultVector& faults);
// The problem with faults, RemoveFaults the other way; a readout time does not count, since nobody knows the
// motion.
MotionProblem PlantFaults(MotionProblem problem, const FaultVector& faults);

}  // namespace rcme
