#pragma once

#include <memory>

#include "estimator/estimator_model.h"
#include "estimator/ransac_options.h"

namespace rcme {

enum class SampleTest { kOn, kOff };

// RCME, or with SampleTest::kOff pRCME: RCME without the test of a model against its sample, and without the
// option sample_significance_level.
std::unique_ptr<EstimatorModel> RcmeModel(SampleTest sample_test);

// The same from options in the code. Throws InputError if they contradict each other.
std::unique_ptr<MotionEstimator> MakeRcme(const RansacOptions& options, SampleTest sample_test);

}  // namespace rcme
