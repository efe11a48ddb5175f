// Step 6 of rcme_calibrated: how likely each mode is to be the camera's motion.
#pragma once

#include <array>

#include "estimator/calibrated/contrast.h"
#include "estimator/calibrated/mode.h"
#include "estimator/motion_prior.h"

namespace rcme {

// The properties of a single mode that its weight depends on.
struct ModeTraits {
  int num_explained = 0;     // matches that are inliers with a probability above one half
  double scale = 1.0;        // s of the noise (mixture_parameters.h)
  double log_det = 0.0;      // ln det(s^2 H), H the information of the matches (FindMatchInformation)
  double forwardness = 0.0;  // in [0, 1]: 0 for travel across the optical axes, 1 for travel along them
  double turn_rad = 0.0;     // angle of the rotation
};

// |(t1 + t2) z| / 2: the cosine of the angle between the direction of travel and the optical axis z, averaged
// over the frames of the two cameras. It does not depend on the order of the images.
double ComputeForwardness(const RelativePose& pose);

inline constexpr size_t kNumModeTerms = 8;
extern const std::array<const char*, kNumModeTerms> kModeTermNames;

// x_1 to x_8, the evidence for mode a against mode b. Five come from the matches,
//
//   exclusive   sign(e) sqrt|e|, e the log-likelihood ratio over matches that only one of them explains
//   shared      the log-likelihood ratio over matches that both explain, over its standard deviation,
//               sqrt(variance + 10)
//   explained   ln(n_a / n_b) of the numbers of explained matches
//   noise       ln(s_a / s_b)
//   width       sign(d) sqrt(|d| / (1 + n / 10)), d = ln(det(s_b^2 H_b) / det(s_a^2 H_a)), n the mean of n_a
//               and n_b: how much less the matches of a would determine the motion at the same noise
//
// and three from a prior of the motion, which decides where two motions explain the same matches, as on a
// plane. f is the forwardness, w the angle of the rotation in rad:
//
//   forward     f_a - f_b
//   axial       g_a - g_b, g = max(f - 0.95, 0) / 0.05: within 18 deg of the axis
//   turn        ln((w_a + 0.05) / (w_b + 0.05))
//
// Exchanging a and b changes all signs.
std::array<double, kNumModeTerms> ComputeModeTerms(const Contrast& a_against_b, const ModeTraits& a,
                                                   const ModeTraits& b);

// Log-odds of mode a against mode b, sum_k b_k x_k.
//
// The Bayes factor with Laplace's approximation would consist of e, the sum over the shared matches, half of
// ln(det Sigma_a / det Sigma_b) and the logarithm of the prior. Here the b_k are those of a logistic
// regression instead: which of two modes is the camera's motion, in trials of a population of conditions and
// of families of scenes (scripts/fit_calibrated, fitted_constants.h). They differ from the Bayes factor in
// four ways:
// - If noise is dependent or outliers are coherent, densities differ from those of the model. Evidence is
//   then worth less than its nats, and the more there is, the less each nat is worth. Hence the square root.
// - A mode that needs less noise or explains more matches is more likely for that alone.
// - The ratio of the determinants counts less the more matches there are, as all evidence does.
// - The prior's weights are 0.6 of the fitted ones, because cameras elsewhere may move otherwise than the
//   simulator's.
//
// The prior says that cameras travel along their axes or across them rather than obliquely, and turn little.
// It is fitted to the simulator's motions; of its eight kinds with a translation, two have any direction
// (general, vanishing_baseline). Real pairs agree in kind: of 234 with a known motion, 25 % travel within
// 18 deg of the axis and 11 % have a forwardness of 0.6 to 0.95, where any direction would give 5 and 35 %.
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
//   log q(p) - (log|H + Q| - log|H|) / 2,
//   log q(p) = LogPeakOverUniform + log(.95 e^-cost + .05 5^-d e^(-cost / 25)),  d its degrees of freedom
//
// It is not tempered as the evidence of the matches is, because the noise of the prior is independent of that
// of the matches, and stated. But one measurement in twenty is taken to have five times the stated standard
// deviations: a biased sensor may lie nearer to the twin of a plane than to the camera's motion, by chance
// and by many of its own standard deviations.
double ComputePriorEvidence(const MotionPrior& prior, const Mode& mode);
// The Hessian of the likelihood alone: the mode's Hessian without the prior.
Matrix5d FindMatchInformation(const MotionPrior* prior, const Mode& mode);

// Whether the modes are two motions, that of the camera and that of an object: each explains at least twelve
// matches clearly better than the other.
bool IsSecondMotion(const Contrast& a_against_b);

// What one of two motions explains.
struct MotionSupport {
  int num_better = 0;   // matches that it explains better than the other
  double extent = 0.0;  // of all that it explains (explanation.h)
};

inline constexpr size_t kNumSecondMotionTerms = 2;
extern const std::array<const char*, kNumSecondMotionTerms> kSecondMotionTermNames;

// What speaks for motion a against b:
//
//   number   ln(n_a / n_b) of the numbers of matches that either explains better, each at least 1
//   extent   ln(a_a / a_b) of the extents, within [-1.5, 1.5]; 0 if the matches of one lie on a line
//
// The scene surrounds an object: its matches cover more of the images, even if there are fewer of them.
std::array<double, kNumSecondMotionTerms> ComputeSecondMotionTerms(const MotionSupport& a,
                                                                   const MotionSupport& b);

// Log-odds that the second of two motions is the camera's, ln odds + sum_k b_k x_k, the b_k by a logistic
// regression as those of ModeLogOdds. -inf if the odds are 0 or it explains nothing better.
double SecondMotionLogOdds(double odds, const MotionSupport& answer, const MotionSupport& second);

}  // namespace rcme
