#pragma once

#include <optional>
#include <string>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// The first number in which two answers differ by a single bit, with both values; nothing: they are the same
// bytes.
std::optional<std::string> FirstDifference(const MotionEstimate& a, const MotionEstimate& b);

// The same of two problems.
std::optional<std::string> FirstDifference(const MotionProblem& a, const MotionProblem& b);

}  // namespace rcme
