// Step 3 of rcme_calibrated: a match that the motion follows more than all others is seldom right.
//
// A wrong match that happens to lie on its epipolar line has a parallax of any size. Where it is far greater
// than that of the scene, the match decides on the motion by itself, and its residual is zero: nothing but
// its influence shows that it is wrong. A right match of a point far nearer than all others is left out with
// it: the motion loses precision, and on a plane the point that would tell its two motions apart.
#pragma once

#include "estimator/calibrated/explanation.h"

namespace rcme {

// Probability that a match with the leverage h is wrong,
//
//   logit = logit(p) + c0 + c1 log(h / q),
//
// p the probability that it is wrong as the others predict its residual, q the leverage that one in twenty of
// the matches which the motion explains exceeds. A logistic regression over these matches in fifteen families
// of scenes, each with the same weight (seed 36); the coefficient of logit(p) came out as 1.00.
double ProbabilityWrong(double probability_by_residual, double leverage, double leverage_of_twentieth);

// Of every match that the mode explains; zero for the others, which are wrong as it is.
std::vector<double> WrongByInfluence(const Mode& mode, const Explanation& explanation);

}  // namespace rcme
