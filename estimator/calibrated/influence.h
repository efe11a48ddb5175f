// Step 3 of rcme_calibrated: a match with much more leverage than all others is seldom an inlier.
//
// An outlier that happens to lie on its epipolar line may have any parallax. If this is far greater than the
// parallax of the scene, the match determines the motion by itself. Its residual is then zero, and only its
// influence shows that it is an outlier. The cost: an inlier far nearer than all other points is left out,
// too. Then the motion loses precision, and on a plane it may lose the point that would distinguish its two
// motions.
#pragma once

#include "estimator/calibrated/explanation.h"

namespace rcme {

// Probability that a match with leverage h is an outlier,
//
//   logit = logit(p) + c0 + c1 log(h / q),
//
// where p is the probability that it is one, judged by its residual under the motion fitted without it, and q
// the 0.95 quantile of the leverage of the matches that the motion explains. c0 and c1 come from a logistic
// regression over such matches in fifteen families of scenes with equal weights (seed 36); the coefficient of
// logit(p) came out as 1.00.
double ProbabilityWrong(double probability_by_residual, double leverage, double leverage_of_twentieth);

// This probability for each match that the mode explains, and zero for the others.
std::vector<double> WrongByInfluence(const Mode& mode, const Explanation& explanation);

// The matches for which it is at least one half, in ascending order.
std::vector<size_t> ListWrongByInfluence(const Mode& mode, const Explanation& explanation);

}  // namespace rcme
