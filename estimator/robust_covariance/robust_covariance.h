// A covariance that stays right where the errors of matches are not independent.
//
//   C = factor d (s_0 C_0 + C_shared) + a a' + G Sigma_K G'
//
//   C_0  of independent errors: halfway between the sandwich of the matches' own residuals, HC3
//        (clustered_covariance.h), which holds where some matches are noisier than others and is uncertain
//        with few, and s^2 A^-1, s^2 the residuals' variance, which is neither
//   s_0  the share of the residuals' variance that is each match's own; C_shared is what the rest adds:
//        matches of one key point (within 1 px of each other in either image) and neighbours err alike, as
//        far as the residuals themselves say so (residual_variances.h)
//   d    design effect: how much greater the sandwich is, on average over the five directions, if the matches
//        in one of 8x8 blocks of image 1 are a group, tr((s_0 C_0 + C_shared)^-1 C_B) / 5, where it exceeds
//        1.25: what blocks see and a correlation that falls with the distance does not
//   a    from the motion to the least-squares optimum p* of the matches that agree with it, whose covariance
//        the former is. Nil for an estimator that has fitted these; else the distance is known, and part of
//        the error: p - q = a + (p* - q), q the true motion. Where p* is efficient, p* and a are uncorrelated
//        (Hausman 1978). Wrong matches of great leverage within the reach of an M-estimator's loss, or a
//        motion that was not refined, are seen in it.
//   factor  what residuals cannot see: errors that reach as far as the image, of the lens or the calibration
//   G Sigma_K G'  what an uncertain calibration adds (uncertainty/calibration_prior.h)
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimator/motion_problem.h"
#include "estimator/robust_covariance/residual_variances.h"
#include "estimator/uncertainty/calibration_prior.h"

namespace rcme {

struct RobustCovarianceOptions {
  double factor = 1.0;
  // Adds the sandwich of 4x4 blocks, a delete-one-block jackknife to first order: conservative.
  bool adds_jackknife = false;
  CalibrationPrior calibration;
  // Variances that are known of the camera, in place of those that the pair's own residuals tell; none of
  // Parameters.
  std::optional<KnownVariances> known_variances = {};
};
// covariance_factor and covariance_jackknife.
std::vector<Parameter> Parameters(RobustCovarianceOptions& options);

// The least-squares motion of the matches that agree with it at the level of a fit, those of great leverage
// aside (refinement/fit_set.h), with the noise of their own residuals, from a motion and its inliers: an
// estimator's inliers may be cut at two standard deviations, at which residuals have three quarters of their
// variance. The motion and the inliers as they are where there is none.
struct AgreeingFit {
  RelativePose cam2_from_cam1;
  std::vector<int> fitted;
};
AgreeingFit FitAgreeing(const MotionProblem& problem, const RelativePose& pose, std::span<const int> inliers);

// C. With `own_cov`, a sandwich that the estimator has itself of its matches as if they were independent,
// that takes the place of C_0, without a. Nothing where five or fewer matches are fitted, or they do not
// determine the motion.
std::optional<Matrix5d> RobustCovariance(const MotionProblem& problem, const RelativePose& pose,
                                         std::span<const int> inliers, const RobustCovarianceOptions& options,
                                         const std::optional<Matrix5d>& own_cov = std::nullopt);

}  // namespace rcme
