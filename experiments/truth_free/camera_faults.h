// What may be wrong with a camera that all pairs of a set share, and how it moves the key points.
#pragma once

#include <Eigen/Core>
#include <array>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"
#include "estimator/geometry/pose.h"

namespace rcme {

enum class CameraFault { kFocalLength, kPrincipalPointX, kPrincipalPointY, kDistortion, kReadoutTime };
inline constexpr std::array kCameraFaults = {CameraFault::kFocalLength, CameraFault::kPrincipalPointX,
                                             CameraFault::kPrincipalPointY, CameraFault::kDistortion,
                                             CameraFault::kReadoutTime};
inline constexpr int kNumCameraFaults = static_cast<int>(kCameraFaults.size());

struct CameraFaultText {
  const char* name;         // in files
  const char* words;        // for people
  const char* unit;         // "%", "px", ""
  double per_unit;          // 100 where the unit is per cent
  double nominal;           // a fault of less is none that matters
  const char *more, *less;  // what a positive and a negative one is
};
const CameraFaultText& TextOf(CameraFault fault);

using ShiftsByFaults = Eigen::Matrix<double, 4, kNumCameraFaults>;

// d [x1; x2] / d theta, px, of what is observed, at theta = 0; the columns in the order of kCameraFaults:
//
//   focal length      assumed f = true f (1 + theta):           -(x - c)
//   principal point   assumed c = true c + theta, px:           -1 along x, along y
//   distortion k1     imaged at (1 + theta |ray|^2) ray:         |ray|^2 (x - c)
//   readout time      row y is read theta ((y + 1/2) / height - 1/2) of the time between the images later
//   than
//                     the middle one: that share times v, the velocity of the point's image.
//
// The last is of a motion whose rotation vector w and translation t grow evenly in time: v_1 is the image of
// w x X_1 + t and v_2 that of w x (X_2 - t) + t, X the point at the depth that the motion `cam2_from_cam1`
// gives the match (baseline 1). These are the models of simulator/calibration_error.h and camera_defects.h.
ShiftsByFaults ShiftsOf(const Camera& camera1, const Camera& camera2, const RelativePose& cam2_from_cam1,
                        const Correspondence& match);

}  // namespace rcme
