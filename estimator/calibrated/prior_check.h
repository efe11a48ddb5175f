// Tests whether a prior of the motion (motion_prior.h) is compatible with the matches.
//
// The matches alone may leave several motions, among which the prior is to choose. A prior far from the most
// likely motion is wrong only if it is as far from all others. So the answer of the matches alone gives a
// list of motions, and the prior's p value is the greatest of
//
//   (1 - w) p_exact + w p_errors,   p = P(chi-square > d^2),   d^2 = r' (I + J C J')^-1 r (ComputePriorTail)
//
// over those with a notable weight; C is the covariance of the motion by the matches. p_errors is that of the
// law if the calibration has errors that nobody stated, and w their probability (unstated_errors.h). If the
// prior and C are right and the list contains the camera's motion, the p value is below a level with at most
// about the probability of that level.
//
// The level is 1e-3. After a false alarm the answer is that of the matches alone, no worse than without a
// prior. This cost is small enough for one in a thousand. A wrong prior that is not detected is within about
// four standard deviations of prior and matches combined (chi-square of 16.3 with three degrees of freedom),
// so that the covariance of the answer has that distance in its tails; or it is so with errors of the
// calibration, which the answer then counts as probable (UpdateByPrior). If the matches leave much open, C is
// large, and they cannot contradict the prior.
#pragma once

#include <span>

#include "estimator/calibrated/unstated_errors.h"

namespace rcme {

inline constexpr double kPriorLevel = 1e-3;

// A motion that the matches alone suggest.
struct MotionBelief {
  RelativePose pose;
  Matrix5d covariance = Matrix5d::Zero();  // [rotation, direction], rad^2
  double weight = 0.0;
  UnstatedErrors errors = {};  // of the calibration; `covariance` is that without them
};

// The p value above; 1 if no motion has a notable weight.
double ComputePriorPValue(const MotionPrior& prior, std::span<const MotionBelief> beliefs);

}  // namespace rcme
