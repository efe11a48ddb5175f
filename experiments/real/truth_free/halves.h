// The motions of two halves of a pair's matches, held against their covariances.
#pragma once

#include <optional>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

// The halves share no match, so that the difference of their motions has the sum of their covariances, if
// errors of different matches are independent. Errors that are correlated in space (neighbours, lens,
// calibration, rolling shutter) are common to random halves and differ between halves of an image.
enum class Split { kLeftRight, kUpperLower, kRandom, kRandomAgain };
inline constexpr Split kSpatialSplits[] = {Split::kLeftRight, Split::kUpperLower};
inline constexpr Split kRandomSplits[] = {Split::kRandom, Split::kRandomAgain};

// Normalised squared difference, chi-square with 5 degrees of freedom. The border lies at the median of the
// inliers of `whole` in image 1. Nothing where a half has fewer than 20 matches or gives no motion.
std::optional<double> DifferenceOfHalves(const MotionProblem& problem, const MotionEstimate& whole,
                                         Split split, const MotionEstimator& estimator,
                                         const StreamName& name);

// (a - b)' (C_a + C_b)^-1 (a - b) of two motions, whose tangents are brought together.
double NormalizedDifference(const MotionEstimate& a, const MotionEstimate& b);

}  // namespace rcme
