// Whether a prior of the motion (motion_prior.h) can be right, given the matches.
//
// The matches alone may leave several motions, and it is the prior's part to choose among them: a prior that
// is far from the most likely one is wrong only if it is as far from all the others that they leave. So the
// answer of the matches alone gives a list of motions, and the prior's p value is the greatest of
//
//   P(chi-square > d^2),   d^2 = r' (I + J C J')^-1 r   (ComputePriorTail)
//
// over those that have a notable weight; C is the covariance of the motion by the matches. Of a right prior,
// where the camera's motion is among them and C is right, the p value is below a level with at most the
// probability of that level.
//
// The level is 1e-3. A false alarm costs what the prior would have added: the answer is then that of the
// matches alone, no worse than without a prior, so that one in a thousand is cheap. A wrong prior that goes
// unnoticed is within about four standard deviations of both (chi-square of 16.3 with three degrees of
// freedom), and the answer's covariance has that distance in its tails. Where the matches leave much open, C
// is large, and the prior cannot be contradicted by them.
#pragma once

#include <span>

#include "estimator/motion_prior.h"

namespace rcme {

inline constexpr double kPriorLevel = 1e-3;

// A motion by the matches alone.
struct MotionBelief {
  RelativePose pose;
  Matrix5d covariance = Matrix5d::Zero();  // [rotation, direction], rad^2
  double weight = 0.0;
};

// The p value of the header; 1 without a motion of notable weight.
double ComputePriorPValue(const MotionPrior& prior, std::span<const MotionBelief> beliefs);

}  // namespace rcme
