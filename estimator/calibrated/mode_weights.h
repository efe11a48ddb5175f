// Step 6 of rcme_calibrated: how likely each mode is to be the camera's motion.
#pragma once

#include <vector>

#include "estimator/calibrated/contrast.h"

namespace rcme {

// Log-odds of mode a against mode b,
//
//   kExclusive (exclusive + what `shared` has beyond 3 sd) + kShared shared / sd, sd = sqrt(variance + 10)
//       + kWidth n / (n + 50) clamp(log(det Sigma_a / det Sigma_b), -5, 5),
//
// n the mean number of matches that the two explain, Sigma without the scale of the noise. The Bayes factor
// with Laplace's approximation would have the coefficients 1, 1 (of `shared` itself) and 1/2. These are of a
// logistic regression of failure on all rivals of an answer, over planes, nearly planar scenes, indoor and
// outdoor scenes and few matches (seeds 7 to 13; what it gives on another seed:
// results/calibrated). The densities are not quite those of the model, so that evidence is worth
// less than its nats, and the widths of modes of few matches are themselves uncertain.
double ModeLogOdds(const Contrast& a_against_b, double log_det_ratio, double num_explained);

// Evidence of a motion against there being none, nats: log-likelihood of the matches with each match's
// density as the others predict it, less that of wrong matches alone, less kSearchNats: the logarithm of the
// number of motions that were looked at, 7 to 11, and what the fit of a motion to wrong matches gains beside
// (of 7 to 25, 21 to 25 gave the best Brier scores on 30 to 200 matches with 90 and 95 % wrong, and cost
// nothing where there are more right ones).
double EvidenceOfMotion(const Explanation& mode, const MixtureParameters& mixture, double background);
inline constexpr double kSearchNats = 22.0;

// Whether the two are motions of their own, the camera's and an object's: either explains a dozen matches
// clearly better than the other.
bool IsSecondMotion(const Contrast& a_against_b);

// Log-odds that the second motion is the camera's: log(odds (num_second / num_answer)^3), a prior; the
// numbers are of the matches that either explains better.
double SecondMotionLogOdds(double odds, int num_answer, int num_second);

}  // namespace rcme
