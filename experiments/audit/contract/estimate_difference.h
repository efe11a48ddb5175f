#pragma once

#include <optional>
#include <string>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// The first number in which two answers differ by at least one bit, with both values; nullopt if they are the
// same bytes.
std::optional<std::string> FirstDifference(const MotionEstimate& a, const MotionEstimate& b);

// The same for two problems.
std::optional<std::string> FirstDifference(const MotionProblem& a, const MotionProblem& b);

}  // namespace rcme
