// Step 6 of rcme_calibrated: how likely each mode is to be the camera's motion.
#pragma once

#include <array>
#include <vector>

#include "estimator/calibrated/contrast.h"
#include "estimator/calibrated/mode.h"
#include "estimator/motion_prior.h"

namespace rcme {

// The properties of a single mode that its weight depends on.
struct ModeTraits {
  int num_explained = 0;             // matches that are inliers with a probability above one half
  double scale = 1.0;                // s of the noise (mixture_parameters.h)
  double log_det_information = 0.0;  // of the Hessian without the scale of the noise
  double depth_in_noise = 0.0;       // UsualDepthInNoise
};

inline constexpr size_t kNumModeTerms = 6;
extern const std::array<const char*, kNumModeTerms> kModeTermNames;

// x_1 to x_6, the evidence for mode a against mode b:
//
//   exclusive   sign(e) sqrt|e|, e the log-likelihood ratio over matches that only one of them explains
//   shared      the log-likelihood ratio over matches that both explain, over its standard deviation,
//               sqrt(variance + 10)
//   explained   ln(n_a / n_b) of the numbers of explained matches
//   noise       ln(s_a / s_b)
//   width       ln(det Sigma_a / det Sigma_b), within +-10; Sigma without the scale of the noise
//   parallax    ln((1 + z_a) / (1 + z_b)), z the parallax in noise that a fifth of the matches exceed, at
//               least 0
//
// Exchanging a and b changes all signs.
std::array<double, kNumModeTerms> ComputeModeTerms(const Contrast& a_against_b, const ModeTraits& a,
                                                   const ModeTraits& b);

// Log-odds of mode a against mode b, sum_k b_k x_k.
//
// The Bayes factor with Laplace's approximation would consist of e, the sum over the shared matches and half
// of the width. Here the b_k are those of a logistic regression instead: which of two modes is the camera's
// motion, in trials of a population of conditions and of families of scenes (scripts/fit_calibrated,
// fitted_constants.h). They differ from the Bayes factor in three ways:
// - If noise is dependent or outliers are coherent, densities differ from those of the model. Evidence is
//   then worth less than its nats, and the more there is, the less each nat is worth. Hence the square root.
// - A mode that needs less noise or explains more matches is more likely for that alone.
// - The weight of the parallax is negative. It acts as a prior density that falls with the parallax, about as
//   its inverse. Under a uniform density, noise could be explained as parallax at no cost.
double ModeLogOdds(const Contrast& a_against_b, const ModeTraits& a, const ModeTraits& b);

// Evidence of a motion against no motion at all, nats: the log-likelihood of the matches, each by its density
// as the other matches predict it, minus that of outliers alone, minus kSearchNats.
//
// kSearchNats pays for the search: the logarithm of the number of motions tried, 7 to 11, and the likelihood
// that fitting a motion to outliers gains. Of the values 7 to 25, 21 to 25 gave the best Brier scores on 30
// to 200 matches with 90 and 95 % outliers, and cost nothing with more inliers.
double EvidenceOfMotion(const Explanation& mode, const MixtureParameters& mixture, double background);
inline constexpr double kSearchNats = 22.0;

// Evidence of a prior of the motion (motion_prior.h) for a mode, nats: the log density of the prior's
// measurements if the mode is the camera's motion, minus that of measurements unrelated to it.
//
// Laplace's approximation about the optimum p of the likelihood L times the prior density q, with Hessians H
// and Q: the integral of L q over the mode is L(p) q(p) |H + Q|^(-1/2) up to powers of 2 pi, that of L alone
// is L(p) |H|^(-1/2). ModeLogOdds weighs the likelihood and |H|, as without a prior. The rest is
//
//   log q(p) - (log|H + Q| - log|H|) / 2,   log q(p) = LogPeakOverUniform - cost
//
// It is not tempered as the evidence of the matches is, because the noise of the prior is independent of that
// of the matches, and stated.
double ComputePriorEvidence(const MotionPrior& prior, const Mode& mode);
// The Hessian of the likelihood alone: the mode's Hessian without the prior.
Matrix5d FindMatchInformation(const MotionPrior* prior, const Mode& mode);

// Whether the modes are two motions, that of the camera and that of an object: each explains at least twelve
// matches clearly better than the other.
bool IsSecondMotion(const Contrast& a_against_b);

// Prior log-odds that the second motion is the camera's: log(odds (num_second / num_answer)^3). The numbers
// count the matches that either explains better.
double SecondMotionLogOdds(double odds, int num_answer, int num_second);

}  // namespace rcme
