// Describes an answer of rcme_calibrated in words: the main cause of its uncertainty comes first.
#pragma once

#include <string>
#include <vector>

#include "estimator/calibrated/model_check.h"
#include "estimator/calibrated/modes_verdict.h"
#include "estimator/motion_estimate.h"

namespace rcme {

// The cause of the largest part of the probability of failure, or kNone if no part exceeds 0.01.
Doubt FindDoubt(const std::vector<ExplainedMode>& modes, const ModeWeights& weights,
                const ModesVerdict& verdict);

// One sentence. `estimate` needs all fields but its message; `sigma_px`: its noise level in the pixels of the
// images.
std::string DescribeAnswer(const MotionEstimate& estimate, double sigma_px, const ModelCheck& check);

}  // namespace rcme
