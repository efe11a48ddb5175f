#pragma once

#include <memory>

#include "estimator/estimator_model.h"
#include "estimator/ransac_options.h"

namespace rcme {

// The paper's "Standard": RANSAC by inlier count with the noise-only threshold, then the Gold Standard
// refinement. It has no entropies and does not test its samples, so it lacks the options mu, quality_test,
// selection, early_stop_entropy, sample_significance_level and reading. The tests of the refined motion are
// off by default, as in the paper.
std::unique_ptr<EstimatorModel> StandardModel();

// The same from RansacOptions; leave early_stop_entropy off. Here the default levels of the tests of the
// refined motion depend on the reading. Throws InputError if options contradict each other.
std::unique_ptr<MotionEstimator> MakeStandard(const RansacOptions& options);

}  // namespace rcme
