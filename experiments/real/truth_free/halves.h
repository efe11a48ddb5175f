// Compares the motions estimated from two halves of a pair's matches with their covariances.
#pragma once

#include <optional>

#include "estimator/motion_estimator.h"

namespace rcme {

// The halves share no match. If errors of different matches are independent, the covariance of the difference
// of the two motions is the sum of their covariances. Errors that are correlated in space (neighbours, lens,
// calibration, rolling shutter) are common to random halves, but differ between halves of an image.
enum class Split { kLeftRight, kUpperLower, kRandom, kRandomAgain };
inline constexpr Split kSpatialSplits[] = {Split::kLeftRight, Split::kUpperLower};
inline constexpr Split kRandomSplits[] = {Split::kRandom, Split::kRandomAgain};

// Normalised squared difference, chi-square with 5 degrees of freedom. Halves of the image meet at the median
// coordinate of the inliers of `whole` in image 1. nullopt: a half has fewer than 20 matches or no motion.
std::optional<double> DifferenceOfHalves(const MotionProblem& problem, const MotionEstimate& whole,
                                         Split split, const MotionEstimator& estimator,
                                         const StreamName& name);

// (a - b)' (C_a + C_b)^-1 (a - b) of two motions, with C_b transformed to the tangent basis at a. The
// covariances are those without errors of the calibration that nobody stated, which both share.
double NormalizedDifference(const MotionEstimate& a, const MotionEstimate& b);

}  // namespace rcme
