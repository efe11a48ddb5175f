// Step 6 of rcme_calibrated: how likely each mode is to be the camera's motion.
#pragma once

#include <vector>

#include "estimator/calibrated/contrast.h"

namespace rcme {

// Log-odds of a rival against the answer, after Vuong 1989: with
//
//   D = exclusive + shared / 2 + (log det Sigma_answer - log det Sigma_rival) / 2,   z = D / sqrt(V + 1)
//
// V the variance of the per-match differences, the more conservative (the greater) of log Phi(-z) / Phi(z),
// which doubts D as far as its terms scatter, and of the Bayes value -D; at most kGreatestLogOdds, as the
// answer is the one that the contrast prefers.
double RivalLogOdds(const Contrast& answer_against_rival, double log_det_ratio);
inline constexpr double kGreatestLogOdds = -0.7;

// Evidence of a motion against there being none, nats: log-likelihood of the matches with each match's
// density as the others predict it, less that of wrong matches alone, less the logarithm of the number of
// motions that were looked at.
double EvidenceOfMotion(const Explanation& mode, const MixtureParameters& mixture, double background);
inline constexpr double kSearchNats = 7.0;

// Log-odds that a second motion is the camera's: log(odds (num_b / num_a)^1.5), a prior; num_a and num_b are
// the matches that the answer and it explain alone.
double SecondMotionLogOdds(double odds, int num_answer, int num_second);

}  // namespace rcme
