// Step 6 of rcme_calibrated: how likely each mode is to be the camera's motion.
#pragma once

#include <array>
#include <vector>

#include "estimator/calibrated/contrast.h"
#include "estimator/calibrated/mode.h"
#include "estimator/motion_prior.h"

namespace rcme {

// What a mode is by itself.
struct ModeTraits {
  int num_explained = 0;             // matches that are right with a probability of more than one half
  double scale = 1.0;                // s of the noise (mixture_parameters.h)
  double log_det_information = 0.0;  // of the Hessian in units of the mode's own noise
  double depth_in_noise = 0.0;       // UsualDepthInNoise
};

inline constexpr size_t kNumModeTerms = 6;
extern const std::array<const char*, kNumModeTerms> kModeTermNames;

// x_1 to x_6, what speaks for mode a against mode b:
//
//   exclusive   sign(e) sqrt|e|, e the log-likelihood over matches that only one of them explains
//   shared      the same over matches that both explain, over its standard deviation, sqrt(variance + 10)
//   explained   ln(n_a / n_b) of the numbers of matches
//   noise       ln(s_a / s_b)
//   width       ln(det Sigma_a / det Sigma_b), within +-10; Sigma without the scale of the noise
//   parallax    ln((1 + z_a) / (1 + z_b)), z the parallax in noise that a fifth of the matches exceed, at
//               least 0
//
// The other way round they have the other sign.
std::array<double, kNumModeTerms> ComputeModeTerms(const Contrast& a_against_b, const ModeTraits& a,
                                                   const ModeTraits& b);

// Log-odds of mode a against mode b, sum_k b_k x_k.
//
// The Bayes factor with Laplace's approximation would have e, the sum over the shared matches and half of the
// width, and nothing else. These b are those of a logistic regression: which of two modes is the camera's
// motion, over trials of a population of conditions and of the families (scripts/fit_calibrated,
// fitted_constants.h). The densities are not those of the model where noise is dependent or wrong matches are
// coherent, so that evidence is worth less than its nats, and the less the more there is of it: the root.
// That a mode needs less noise, or explains more matches, says something beside. b of the parallax is
// negative: a prior density that falls with the parallax, about as its inverse does, where a uniform one
// would let noise be explained as parallax at no cost.
double ModeLogOdds(const Contrast& a_against_b, const ModeTraits& a, const ModeTraits& b);

// Evidence of a motion against there being none, nats: log-likelihood of the matches with each match's
// density as the others predict it, less that of wrong matches alone, less kSearchNats: the logarithm of the
// number of motions that were looked at, 7 to 11, and what the fit of a motion to wrong matches gains beside
// (of 7 to 25, 21 to 25 gave the best Brier scores on 30 to 200 matches with 90 and 95 % wrong, and cost
// nothing where there are more right ones).
double EvidenceOfMotion(const Explanation& mode, const MixtureParameters& mixture, double background);
inline constexpr double kSearchNats = 22.0;

// What a prior of the motion (motion_prior.h) says of a mode, nats: the logarithm of the density of its
// measurements given that the mode is the camera's motion, over that of measurements which know nothing of
// it.
//
// By Laplace's approximation about the optimum p of likelihood L times density q, with H and Q their
// Hessians, the integral of L q over the mode is L(p) q(p) |H + Q|^(-1/2) up to powers of 2 pi, where that of
// L alone is L(p) |H|^(-1/2). The likelihood and |H| are what ModeLogOdds weighs, as without a prior; what
// remains is
//
//   log q(p) - (log|H + Q| - log|H|) / 2,   log q(p) = LogPeakOverUniform - cost
//
// It counts in full beside evidence that the regression has tempered: the noise of the prior is independent
// of that of the matches, and stated.
double ComputePriorEvidence(const MotionPrior& prior, const Mode& mode);
// Of the mode's likelihood alone: its Hessian without the prior's part.
Matrix5d FindMatchInformation(const MotionPrior* prior, const Mode& mode);

// Whether the two are motions of their own, the camera's and an object's: either explains a dozen matches
// clearly better than the other.
bool IsSecondMotion(const Contrast& a_against_b);

// Log-odds that the second motion is the camera's: log(odds (num_second / num_answer)^3), a prior; the
// numbers are of the matches that either explains better.
double SecondMotionLogOdds(double odds, int num_answer, int num_second);

}  // namespace rcme
