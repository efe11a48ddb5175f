// A covariance that stays right where the errors of matches are not independent.
//
//   C = factor d C_H + G Sigma_K G'
//
//   C_H  sandwich of the matches' own residuals, HC3, the matches of one key point (within 1 px of each other
//   in
//        either image) in one group: the same point found twice counts once (clustered_covariance.h)
//   d    design effect: how much greater the sandwich is, on average over the five directions, if matches in
//   one of
//        8x8 blocks of image 1 are a group, max(1, tr(C_H^-1 C_B) / 5). The blocks' own sandwich has too few
//        groups to be trusted direction by direction; its scalar is.
//   factor  what blocks cannot see: errors that reach from block to block, of the lens or the calibration
//   G Sigma_K G'  what an uncertain calibration adds (uncertainty/calibration_prior.h)
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimator/motion_problem.h"
#include "estimator/uncertainty/calibration_prior.h"

namespace rcme {

struct RobustCovarianceOptions {
  double factor = 1.0;
  // Adds the sandwich of 4x4 blocks, a delete-one-block jackknife to first order: conservative.
  bool adds_jackknife = false;
  CalibrationPrior calibration;
};
// covariance_factor and covariance_jackknife.
std::vector<Parameter> Parameters(RobustCovarianceOptions& options);

// The parts, for reports.
struct RobustCovarianceParts {
  double key_point_effect = 1.0;          // max(1, tr(C_0^-1 C_H) / 5), C_0 the HC3 of single matches
  double block_effect = 1.0;              // d
  Matrix5d own = Matrix5d::Zero();        // C_H
  Matrix5d jackknife = Matrix5d::Zero();  // of 4x4 blocks
  Matrix5d inverse_information = Matrix5d::Zero();
  std::vector<int> fitted;  // matches that the sandwiches are of
};

// The matches that a motion is taken to be fitted to: its inliers, and what agrees with it at the level of a
// fit (refinement/fit_set.h) with the noise of the inliers' own residuals: an estimator's inliers may be cut
// at two standard deviations, at which residuals have three quarters of their variance. Nothing where five or
// fewer matches are fitted, or they do not determine the motion.
std::optional<RobustCovarianceParts> RobustParts(const MotionProblem& problem, const RelativePose& pose,
                                                 std::span<const int> inliers);

// C. With `own_cov`, a sandwich that the estimator has itself of its matches as if they were independent,
// that takes the place of C_H, times the key points' effect. Nothing: see RobustParts.
std::optional<Matrix5d> RobustCovariance(const MotionProblem& problem, const RelativePose& pose,
                                         std::span<const int> inliers, const RobustCovarianceOptions& options,
                                         const std::optional<Matrix5d>& own_cov = std::nullopt);

}  // namespace rcme
