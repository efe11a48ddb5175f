#pragma once

#include <vector>

#include "estimator/geometry/correspondence.h"
#include "parameters/parameter.h"
#include "simulator/view_pair.h"

namespace rcme {

// What real cameras have and an ideal pinhole does not; no estimator knows of it.
struct CameraDefects {
  // Radial distortion that a calibration has left, of both cameras: a point (x, y, 1) of a ray is imaged as
  // (1 + k1 (x^2 + y^2)) (x, y).
  double distortion_k1 = 0.0;
  // The rows of an image are read one after the other: time from its first to its last, as a share of the
  // time between the two images. The motion's rotation vector w and translation T grow evenly in time, X(a) =
  // Exp(a w) X1 + a T; the middle rows are read at a = 0 and a = 1, so that the true motion is between these.
  double rolling_shutter = 0.0;

  bool IsNone() const { return distortion_k1 == 0.0 && rolling_shutter == 0.0; }
};
std::vector<Parameter> Parameters(CameraDefects& defects);

// Where the two images show a point (camera 1's frame, m), before noise; ExactMatch without defects.
Correspondence ImagedMatch(const ViewPair& view, const CameraDefects& defects,
                           const Eigen::Vector3d& point_in_cam1);

}  // namespace rcme
