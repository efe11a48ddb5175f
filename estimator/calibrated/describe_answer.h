// An answer of rcme_calibrated in words: what makes it uncertain first of all.
#pragma once

#include <string>
#include <vector>

#include "estimator/calibrated/model_check.h"
#include "estimator/calibrated/verdict.h"
#include "estimator/motion_estimate.h"

namespace rcme {

// The greatest part of the probability of failure, where that is more than a hundredth.
Doubt FindDoubt(const std::vector<ExplainedMode>& modes, const ModeWeights& weights, const Verdict& verdict);

// One sentence; `estimate` has all but its message.
std::string DescribeAnswer(const MotionEstimate& estimate, const ModelCheck& check);

}  // namespace rcme
