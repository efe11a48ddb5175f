#pragma once

#include <vector>

#include "estimator/geometry/correspondence.h"
#include "parameters/parameter.h"
#include "simulator/view_pair.h"

namespace rcme {

// Departures of real cameras from the pinhole model. Estimators do not know about them.
struct CameraDefects {
  // Radial distortion left by a calibration, in both cameras: a point (x, y, 1) of a ray is imaged as (1 + k1
  // (x^2 + y^2)) (x, y).
  double distortion_k1 = 0.0;
  // Rolling shutter: the time from the first to the last row of an image, as a share of the time between the
  // two images. The motion's rotation vector w and translation T grow linearly in time, X(a) = Exp(a w) X1 +
  // a T. The middle rows are read at a = 0 and a = 1; the true motion is between these.
  double rolling_shutter = 0.0;

  bool IsNone() const { return distortion_k1 == 0.0 && rolling_shutter == 0.0; }
};
std::vector<Parameter> Parameters(CameraDefects& defects);

// The match of a point (camera 1's frame, m) with defects, before noise. Without defects it is ExactMatch.
Correspondence ImagedMatch(const ViewPair& view, const CameraDefects& defects,
                           const Eigen::Vector3d& point_in_cam1);

// Another point (camera 1's frame, m) whose image 1 is the same pixel, `distance_m` from where camera 1 was
// when it read that pixel. x1_px: that pixel of the point, of ImagedMatch.
Eigen::Vector3d PointOnSameRay(const ViewPair& view, const CameraDefects& defects,
                               const Eigen::Vector3d& point_in_cam1, const Eigen::Vector2d& x1_px,
                               double distance_m);

// Throws InputError if the distortion folds an image of the view: points beyond a circle would be imaged
// inside it.
void CheckDistortion(const ViewPair& view, const CameraDefects& defects);

}  // namespace rcme
