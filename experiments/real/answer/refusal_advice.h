// What a person may try where an estimator gave no motion.
#pragma once

#include <string>
#include <vector>

#include "estimator/motion_estimate.h"
#include "experiments/study/estimator_spec.h"

namespace rcme {

// One sentence each, with the options of this estimator by name; empty for a motion (status ok).
std::vector<std::string> AdviceFor(const MotionEstimate& estimate, const EstimatorSpec& spec);

}  // namespace rcme
