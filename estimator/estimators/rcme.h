#pragma once

#include <memory>

#include "estimator/ransac_estimator.h"
#include "estimator/ransac_options.h"

namespace rcme {

enum class SampleTest { kOn, kOff };

// RCME, and pRCME: the same without the test of the model against its sample. Throws InputError if the
// options contradict each other.
std::unique_ptr<RansacEstimator> MakeRcme(const RansacOptions& options, SampleTest sample_test);

}  // namespace rcme
