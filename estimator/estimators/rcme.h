#pragma once

#include <memory>

#include "estimator/estimator_model.h"
#include "estimator/ransac_options.h"

namespace rcme {

enum class SampleTest { kOn, kOff };

// RCME, and pRCME: the same without the test of the model against its sample; then sample_significance_level
// is no option.
std::unique_ptr<EstimatorModel> RcmeModel(SampleTest sample_test);

// The same from options in the code. Throws InputError if they contradict each other.
std::unique_ptr<MotionEstimator> MakeRcme(const RansacOptions& options, SampleTest sample_test);

}  // namespace rcme
