// The pure rotation that fits a set of matches best.
//
// `Matches` holds sets of matches and sums their equations; its interface is MatchSets of refine_winner.h.
// Equations: refinement/rotation_equations.h or kernels/rotation_equations.h.
#pragma once

#include <functional>
#include <utility>

#include "estimator/refinement/rotation_equations.h"

namespace rcme {

struct RotationFit {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();         // cam2_from_cam1
  Eigen::Matrix3d rotation_cov = Eigen::Matrix3d::Zero();  // 3x3, rad^2, as the block of pose_cov
  int num_within = 0;  // number of all matches with d2 <= threshold under R
  int num_fitted = 0;  // the same within the set; R was fitted to these
  // sum d2 over the fitted; chi-square with 2 num_fitted - 3 degrees of freedom for a rotation
  double energy = 0.0;
};

// Reweighted least squares from `start`, until a step is shorter than 0.001 standard deviations; 0.1 with
// Cauchy's loss, which only serves to find the wrong matches.
Eigen::Matrix3d MinimizeOverRotation(
    const Eigen::Matrix3d& start, Loss loss,
    const std::function<RotationEquations(const Eigen::Matrix3d& R, Loss loss)>& linearize);

// The inverse of the Hessian; not finite if it is singular.
Eigen::Matrix3d ComputeRotationCovariance(const RotationEquations& equations);

// Maximum number of fits after the robust one.
inline constexpr int kMaxRotationRefits = 10;

// Fits from `start` with Cauchy's loss over the set, then by maximum likelihood to its matches within the
// threshold, until these do not change. Stops with num_fitted = 0 if fewer than three of them are left.
template <typename Matches>
RotationFit FitRotation(const Matches& matches, const typename Matches::Set& set,
                        const Eigen::Matrix3d& start, double threshold) {
  using Set = typename Matches::Set;
  const auto minimize = [&](const Set& over, const Eigen::Matrix3d& from, Loss loss) {
    return MinimizeOverRotation(from, loss, [&](const Eigen::Matrix3d& R, Loss rho) {
      return matches.LinearizeRotation(over, R, rho);
    });
  };
  RotationFit fit{.R = minimize(set, start, Loss::kCauchy)};
  Set fitted;
  for (int refit = 0; refit < kMaxRotationRefits; ++refit) {
    const Set within = matches.FindRotated(fit.R, threshold);
    Set selected = matches.Intersect(within, set);
    const bool is_same = refit > 0 && selected == fitted;
    fit.num_within = matches.Count(within);
    fitted = std::move(selected);
    if (is_same) break;
    if (matches.Count(fitted) < 3) {
      fitted = matches.MakeSet({});
      break;
    }
    fit.R = minimize(fitted, fit.R, Loss::kSquared);
  }
  const RotationEquations at = matches.LinearizeRotation(fitted, fit.R, Loss::kSquared);
  fit.num_fitted = matches.Count(fitted);
  fit.energy = at.energy;
  fit.rotation_cov = ComputeRotationCovariance(at);
  return fit;
}

}  // namespace rcme
