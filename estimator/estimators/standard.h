#pragma once

#include <memory>

#include "estimator/estimator_model.h"
#include "estimator/ransac_options.h"

namespace rcme {

// The paper's "Standard": RANSAC by inlier count with the noise-only threshold, then the Gold Standard
// refinement. It has no entropies and does not test its samples: mu, quality_test, selection,
// early_stop_entropy, the sample test's level and the reading are no options of it. The tests of the refined
// motion are off by default, as the paper's Standard has none.
std::unique_ptr<EstimatorModel> StandardModel();

// The same from options in the code, early_stop_entropy off; levels of the tests of the refined motion are by
// default as the reading says. Throws InputError if they contradict each other.
std::unique_ptr<MotionEstimator> MakeStandard(const RansacOptions& options);

}  // namespace rcme
