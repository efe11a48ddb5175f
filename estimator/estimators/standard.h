#pragma once

#include <memory>

#include "estimator/ransac_estimator.h"
#include "estimator/ransac_options.h"

namespace rcme {

// The paper's "Standard": RANSAC by inlier count with the noise-only threshold, then the Gold Standard
// refinement. Uses num_iterations, significance_level, refinement and kappa of the options. Throws InputError
// if the options contradict each other.
std::unique_ptr<RansacEstimator> MakeStandard(const RansacOptions& options);

}  // namespace rcme
