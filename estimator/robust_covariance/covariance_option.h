// The option `covariance: robust`, available for any estimator.
#pragma once

#include <memory>
#include <vector>

#include "estimator/estimator_model.h"
#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"
#include "estimator/robust_covariance/robust_covariance.h"

namespace rcme {

// Adds these options to an estimator:
//
//   covariance  own (default: Make returns what the model itself makes) or robust
//   covariance_factor, covariance_jackknife, focal_sd, principal_point_sd_px, distortion_sd
//               of the robust one; Make throws InputError if one is set without `robust`
//
// With `robust`, a motion (status ok) gets the covariance of robust_covariance.h; the motion, its inliers and
// all other results do not change. If the inliers determine no covariance, the status is degenerate_matches.
// A model that already has an option `covariance` is returned unchanged. Unless `uses_noise_scale`, the
// robust covariance is that of a fit that weights all matches equally.
std::unique_ptr<EstimatorModel> WithRobustCovariance(std::unique_ptr<EstimatorModel> model,
                                                     bool uses_noise_scale = false);

// Throws InputError that names the first option of the robust covariance whose value differs from its
// default, for an estimator without `covariance: robust`. The lists have the same options in the same order.
void RequireUnset(const std::vector<Parameter>& given, const std::vector<Parameter>& unset);

// Replaces the covariance of a motion by the robust one, or refuses the motion. An invalid answer (motion not
// finite, inliers that are no matches) stays unchanged.
void MakeCovarianceRobust(const MotionProblem& problem, const RobustCovarianceOptions& options,
                          const std::optional<Matrix5d>& own_cov, MotionEstimate* estimate);

}  // namespace rcme
