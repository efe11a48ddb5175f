#pragma once

#include "estimator/kernels/match_blocks.h"

namespace rcme {

// The rotation without a translation that fits a set of matches best.
struct RotationFit {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();         // cam2_from_cam1
  Eigen::Matrix3d rotation_cov = Eigen::Matrix3d::Zero();  // 3x3, rad^2, as the block of pose_cov
  MatchMask within;  // of all matches: d2 <= threshold under R (rotation_equations.h)
  MatchMask fitted;  // of the set: the same
  double energy =
      0.0;  // sum d2 over `fitted`; chi-square with 2 |fitted| - 3 degrees of freedom for a rotation
};

// From `start` with Cauchy's loss over the set, then maximum likelihood over its matches within the
// threshold, until they do not change any more. `fitted` is empty where fewer than three matches are left.
RotationFit FitRotation(const MatchBlocks& matches, const MatchMask& set, const Eigen::Matrix3d& start,
                        double threshold);

}  // namespace rcme
