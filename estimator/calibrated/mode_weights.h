// Step 6 of rcme_calibrated: how likely each mode is to be the camera's motion.
#pragma once

#include <vector>

#include "estimator/calibrated/contrast.h"

namespace rcme {

// Log-odds of mode a against mode b,
//
//   kExclusive exclusive + kShared shared / sqrt(variance + 10)
//       + kWidth n / (n + 50) clamp(log(det Sigma_a / det Sigma_b), -5, 5),
//
// n the mean number of matches that the two explain, Sigma without the scale of the noise. The Bayes factor
// with Laplace's approximation would have the coefficients 1, 1 (of `shared` itself) and 1/2. These are of a
// logistic regression on which of two modes is right, over planes, nearly planar scenes, rooms and few
// matches (experiments/results/calibrated): the densities are not quite those of the model, so that evidence
// is worth less than its nats, and the widths of modes of few matches are themselves uncertain.
double ModeLogOdds(const Contrast& a_against_b, double log_det_ratio, double num_explained);

// Evidence of a motion against there being none, nats: log-likelihood of the matches with each match's
// density as the others predict it, less that of wrong matches alone, less the logarithm of the number of
// motions that were looked at.
double EvidenceOfMotion(const Explanation& mode, const MixtureParameters& mixture, double background);
inline constexpr double kSearchNats = 7.0;

// Log-odds that a second motion is the camera's: log(odds (num_b / num_a)^1.5), a prior; num_a and num_b are
// the matches that the answer and it explain alone.
double SecondMotionLogOdds(double odds, int num_answer, int num_second);

}  // namespace rcme
