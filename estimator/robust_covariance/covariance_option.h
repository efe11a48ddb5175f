// The option `covariance: robust`, which any estimator can be given.
#pragma once

#include <memory>

#include "estimator/estimator_model.h"
#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"
#include "estimator/robust_covariance/robust_covariance.h"

namespace rcme {

// The same estimator with the options
//
//   covariance              own (the default: Make gives what the model itself makes) or robust
//   covariance_factor, covariance_jackknife, focal_sd, principal_point_sd_px, distortion_sd  of the robust
//   one
//
// beside its own. The motion, its inliers and whatever else it says stay, number for number; of a motion
// (status ok) the covariance is that of robust_covariance.h. Where the inliers determine none the status is
// degenerate_matches. A model that has an option `covariance` itself stays as it is. The robust covariance is
// of a fit that weighs all matches alike unless `uses_noise_scale`.
std::unique_ptr<EstimatorModel> WithRobustCovariance(std::unique_ptr<EstimatorModel> model,
                                                     bool uses_noise_scale = false);

// Gives a motion the robust covariance, or refuses it. An answer that is none (motion not finite, inliers
// that are no matches) stays.
void MakeCovarianceRobust(const MotionProblem& problem, const RobustCovarianceOptions& options,
                          const std::optional<Matrix5d>& own_cov, MotionEstimate* estimate);

}  // namespace rcme
