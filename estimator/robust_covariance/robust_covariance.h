// A covariance that remains valid if the errors of matches are not independent.
//
//   C = factor d (s_0 C_0 + C_shared) + a a' + G Sigma_K G'
//
//   C_0  for independent errors: the mean of two covariances. One is the sandwich of the matches' own
//        residuals, HC3 (clustered_covariance.h); it holds if some matches are noisier than others, but is
//        uncertain for few. The other is s^2 A^-1, s^2 the residuals' variance; the opposite is true of it.
//   s_0  share of the residuals' variance that belongs to each match alone
//   C_shared  contribution of the rest: matches of one key point (within 1 px of each other in either image)
//        and neighbours have similar errors, as far as the residuals show (residual_variances.h)
//   d    design effect: how much greater the sandwich C_B with the 8x8 blocks of image 1 as groups is, on
//        average over the five directions: tr((s_0 C_0 + C_shared)^-1 C_B) / 5 if that exceeds 1.25, else 1.
//        It captures what blocks see but a correlation that falls with the distance does not.
//   a    from the motion to the least-squares optimum p* of the matches that agree with it, to which the
//        other terms belong. Zero for an estimator that fits these. Otherwise the distance is known and part
//        of the error: p - q = a + (p* - q), q the true motion. If p* is efficient, p* and a are uncorrelated
//        (Hausman 1978). a reveals outliers of great leverage within the reach of an M-estimator's loss, and
//        motions that were not refined.
//   factor  for errors that residuals cannot show because they extend over the whole image: lens, calibration
//   G Sigma_K G'  contribution of an uncertain calibration (uncertainty/calibration_prior.h)
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
  // Adds the sandwich of 4x4 blocks, to first order a delete-one-block jackknife: conservative.
  bool adds_jackknife = false;
  CalibrationPrior calibration;
  // Known variances of the camera, used instead of those estimated from the pair's residuals. Not among
  // Parameters.
  std::optional<KnownVariances> known_variances = {};
};
// The options covariance_factor and covariance_jackknife.
std::vector<Parameter> Parameters(RobustCovarianceOptions& options);

// Computes the least-squares motion of the matches that agree with it, starting from a motion and its
// inliers. The matches agree at the level of a fit and have no great leverage (refinement/fit_set.h); the
// noise is that of their own residuals. This is needed because an estimator may cut its inliers at two
// standard deviations, where residuals have three quarters of their variance. If there is no such motion,
// returns motion and inliers unchanged.
struct AgreeingFit {
  RelativePose cam2_from_cam1;
  std::vector<int> fitted;
};
AgreeingFit FitAgreeing(const MotionProblem& problem, const RelativePose& pose, std::span<const int> inliers);

// Computes C. `own_cov` is the estimator's own sandwich for independent matches. If given, it replaces C_0,
// and a is left out. Returns nullopt if five or fewer matches are fitted, or if they do not determine the
// motion.
std::optional<Matrix5d> RobustCovariance(const MotionProblem& problem, const RelativePose& pose,
                                         std::span<const int> inliers, const RobustCovarianceOptions& options,
                                         const std::optional<Matrix5d>& own_cov = std::nullopt);

}  // namespace rcme
