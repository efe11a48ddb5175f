#pragma once

#include <memory>

#include "estimator/ransac_estimator.h"
#include "estimator/ransac_options.h"

namespace rcme {

// The paper's "Standard": RANSAC by inlier count with the noise-only threshold, then the Gold Standard
// refinement. It has no entropies: mu, quality_test, selection and early_stop_entropy have no effect, nor
// have the sample test's level and the reading, but for the default of the tests of the refined motion: off,
// as the paper's Standard has none; a level of their own, or reading: rank_aware, turns them on. Throws
// InputError if the options contradict each other.
std::unique_ptr<RansacEstimator> MakeStandard(const RansacOptions& options);

}  // namespace rcme
