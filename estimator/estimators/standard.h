#pragma once

#include "estimator/motion_estimator.h"
#include "estimator/ransac_options.h"

namespace rcme {

// The paper's "Standard": RANSAC by inlier count with the noise-only threshold, then the Gold Standard
// refinement. Uses num_iterations, significance_level, refinement and kappa of the options.
class StandardEstimator : public MotionEstimator {
 public:
  // Throws InputError if the options contradict each other.
  explicit StandardEstimator(const RansacOptions& options) : options_(options) { Validate(options); }
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override;

 private:
  RansacOptions options_;
};

}  // namespace rcme
