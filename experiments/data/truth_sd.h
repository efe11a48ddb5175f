#pragma once

#include "estimator/geometry/pose.h"

namespace rcme {

// The uncertainty of a given truth: standard deviations along the axes of camera 2, independent of each
// other.
struct TruthSd {
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // relative to the length of the baseline

  // Returns the 5x5 covariance [rotation, direction] (rad^2) in the tangent space at a pose. Rotation errors
  // w turn camera 2 (R <- Exp(w) R); an error e of the translation turns its direction by B' e, B =
  // DirectionBasis(t).
  Matrix5d CovarianceAt(const RelativePose& pose) const;
};

// Standard deviations of the poses of a data set, per axis.
struct PoseSd {
  double rotation_deg = 0.0;
  double position = 0.0;  // in the unit of the data set

  bool IsZero() const { return rotation_deg == 0.0 && position == 0.0; }
  // Returns whether the baseline is too short for a known direction: at most three standard deviations of
  // the difference of two positions.
  bool IsDirectionWeak(double baseline) const;
};

// Returns the uncertainty of a motion between two poses with independent errors. The variances of both
// rotations and of both positions add up, and a rotation error of the second pose also turns the
// translation. The correlation between rotation and translation that results is neglected. baseline > 0, in
// the unit of the data set.
TruthSd SdOfMotion(const PoseSd& pose, double baseline);

}  // namespace rcme
