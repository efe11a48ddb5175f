#pragma once

#include <memory>

#include "estimator/estimator_model.h"
#include "estimator/ransac_options.h"

namespace rcme {

// `standard` with another score in the loop (robust_scores.h). Options: those of `standard` except the
// implementation, which is always the reference.
std::unique_ptr<EstimatorModel> MsacModel();
std::unique_ptr<EstimatorModel> MlesacModel();

// The same from options in the code. Throws InputError if they contradict each other.
std::unique_ptr<MotionEstimator> MakeMsac(const RansacOptions& options);
std::unique_ptr<MotionEstimator> MakeMlesac(const RansacOptions& options);

}  // namespace rcme
