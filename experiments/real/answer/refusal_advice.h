// Suggests what to try when an estimator returned no motion.
#pragma once

#include <string>
#include <vector>

#include "estimator/motion_estimate.h"
#include "experiments/study/estimator_spec.h"

namespace rcme {

// Returns one sentence per suggestion, with the names of this estimator's options; empty for a motion
// (status ok).
std::vector<std::string> AdviceFor(const MotionEstimate& estimate, const EstimatorSpec& spec);

}  // namespace rcme
