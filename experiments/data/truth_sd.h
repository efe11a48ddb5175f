#pragma once

#include <optional>

#include "estimator/geometry/pose.h"

namespace rcme {

// How far a given truth may itself be off: standard deviations along the axes of camera 2, independent of
// each other.
struct TruthSd {
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // over the length of the baseline

  // 5x5 [rotation, direction], rad^2, in the tangent at a pose: the rotation's errors turn camera 2 (R <-
  // Exp(w) R), and an error e of the translation turns its direction by B' e, B = DirectionBasis(t).
  Matrix5d CovarianceAt(const RelativePose& pose) const;
};

}  // namespace rcme
