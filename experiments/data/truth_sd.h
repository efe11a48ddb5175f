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

// Standard deviations of a data set's own poses, per axis.
struct PoseSd {
  double rotation_deg = 0.0;
  double position = 0.0;  // in the data set's unit

  bool IsZero() const { return rotation_deg == 0.0 && position == 0.0; }
  // A baseline below three standard deviations of the difference of two positions has no known direction.
  bool IsDirectionWeak(double baseline) const;
};

// The truth's own error of a motion between two poses with independent errors: their rotations' and
// positions' variances add, and an error of the second one's rotation turns the translation too. That it
// turns both is left out. baseline > 0, in the data set's unit.
TruthSd SdOfMotion(const PoseSd& pose, double baseline);

}  // namespace rcme
