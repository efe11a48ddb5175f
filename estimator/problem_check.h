#pragma once

#include <optional>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Bound that keeps products of four coordinates far from overflow; no image coordinate is larger.
inline constexpr double kMaxCoordinatePx = 1e6;

// The refusal of a problem that no hypothesis can solve; nullopt if the search may begin. Reasons: invalid
// numbers (including a noise_scale whose length differs from the number of matches, and faults found by
// FindPriorFault), fewer than `min_matches` distinct matches, or all points of one image on one line within
// the noise.
std::optional<MotionEstimate> RefuseUnsolvable(const MotionProblem& problem, int min_matches);

}  // namespace rcme
