#pragma once

#include <optional>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Beyond a million pixels nothing is an image coordinate, and products of four would overflow long after.
inline constexpr double kMaxCoordinatePx = 1e6;

// What makes a problem unsolvable before any hypothesis is drawn: bad numbers (among them a
// noise_scale of another length than the matches, and what FindPriorFault finds), fewer than `min_matches`
// distinct matches, or points of one image on one line within the noise. Nothing: go ahead.
std::optional<MotionEstimate> RefuseUnsolvable(const MotionProblem& problem, int min_matches);

}  // namespace rcme
