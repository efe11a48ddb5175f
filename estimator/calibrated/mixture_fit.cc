#include "estimator/calibrated/mixture_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace rcme {
namespace {

// Weight of the assumed sigma, in matches. With fewer, five matches, which every motion through them fits
// exactly, would drive the scale to zero. With more, an assumed sigma wrong by a factor of four would do
// harm.
constexpr double kPriorMatches = 2.0;
constexpr double kScaleRange = 8.0;  // s stays within this factor of 1
// Tolerated decrease of the likelihood in a step, nats. The gradient does not include c(z), which may
// decrease for a match near an epipole.
constexpr double kTolerance = 1.0;
constexpr double kNegligibleDecrement = 4e-4, kSmallDecrement = 1.0;  // twice the gain of a Newton step, nats
constexpr double kPriorWrongNear = 5.0;  // weight of the prior of q, in outliers with small residuals

// One step of expectation-maximisation. The motion takes five degrees of freedom of the residuals.
MixtureParameters Updated(const MixtureParameters& old, const MixtureSums& sums, int num_used,
                          const MixturePrior& prior) {
  MixtureParameters next = old;
  if (prior.estimates_scale) {
    const double freedom = std::max(sums.num_right - 5.0, 0.0);
    const double prior_squares = kPriorMatches * old.noise.scale_of_gaussian * old.noise.scale_of_gaussian;
    const double variance = (sums.sum_squares + prior_squares) / (freedom + kPriorMatches);
    next.scale = std::clamp(std::sqrt(variance), 1.0 / kScaleRange, kScaleRange);
  }
  next.inlier_ratio = std::clamp((sums.num_right + 0.5) / (num_used + 1.0), 0.01, 0.99);
  const double wrong = num_used - sums.num_right;
  next.outlier_density = (sums.num_wrong_near + kPriorWrongNear) /
                         (2.0 * kNearResidual * wrong + kPriorWrongNear / prior.uniform_density);
  next.outlier_density = std::clamp(next.outlier_density, 0.1 * prior.uniform_density,
                                    std::max(10.0 * prior.uniform_density, 0.5 / kNearResidual));
  return next;
}

// g' H^-1 g: the squared length of the undamped step to the optimum, in standard deviations.
double Decrement(const MixtureSums& sums) {
  return sums.gradient.dot(sums.hessian.llt().solve(sums.gradient));
}

}  // namespace

MixtureParameters FirstGuess(const MixturePrior& prior, double scale, double inlier_ratio) {
  MixtureParameters guess;
  guess.scale = scale;
  guess.inlier_ratio = std::clamp(inlier_ratio, 0.05, 0.95);
  guess.outlier_density = prior.uniform_density;
  return guess;
}

MixtureSums SumPosterior(const MatchBlocks& matches, const MatchMask& mask, const MixturePrior& prior,
                         const RelativePose& pose, const MixtureParameters& parameters) {
  MixtureSums sums = SumMixture(matches, mask, pose, parameters);
  if (prior.motion == nullptr) return sums;
  const PriorTerms terms = EvaluatePrior(*prior.motion, pose);
  sums.log_likelihood -= terms.cost;
  sums.gradient += terms.gradient;
  sums.hessian += terms.hessian;
  return sums;
}

Vector5d SumPosteriorGradient(const MatchBlocks& matches, const MatchMask& mask, const MixturePrior& prior,
                              const RelativePose& pose, const MixtureParameters& parameters) {
  Vector5d gradient = SumMixtureGradient(matches, mask, pose, parameters);
  if (prior.motion != nullptr) gradient += EvaluatePrior(*prior.motion, pose).gradient;
  return gradient;
}

double SumLogPosterior(const MatchBlocks& matches, const MatchMask& mask, const MixturePrior& prior,
                       const RelativePose& pose, const MixtureParameters& parameters) {
  double log_likelihood = SumLogLikelihood(matches, mask, pose, parameters);
  if (prior.motion != nullptr) log_likelihood -= EvaluatePrior(*prior.motion, pose).cost;
  return log_likelihood;
}

ModeFit::ModeFit(const MatchBlocks& matches, const MixturePrior& prior, Mode* mode, MixtureUpdate update)
    : matches_(matches), prior_(prior), mode_(mode), update_(update), num_used_(CountIn(mode->used)) {
  at_ = SumPosterior(matches_, mode->used, prior_, mode->pose, mode->mixture);
}

bool ModeFit::Step() {
  Matrix5d damped = at_.hessian;
  damped.diagonal() *= 1.0 + damping_;
  const Vector5d move = -damped.llt().solve(at_.gradient);
  if (!move.allFinite()) return false;
  const RelativePose pose = Retract(mode_->pose, move);
  MixtureParameters mixture = mode_->mixture;
  if (update_ == MixtureUpdate::kAll) mixture = Updated(mixture, at_, num_used_, prior_);
  const MixtureSums there = SumPosterior(matches_, mode_->used, prior_, pose, mixture);
  if (!std::isfinite(there.log_likelihood)) return false;
  if (there.log_likelihood < at_.log_likelihood - kTolerance) {
    // Was it the motion or the mixture? The density of outliers is not normalised, so that its update may
    // lower the likelihood: keep the mixture and compare again.
    mode_->mixture = mixture;
    at_ = SumPosterior(matches_, mode_->used, prior_, mode_->pose, mode_->mixture);
    if (there.log_likelihood < at_.log_likelihood - kTolerance) {
      damping_ = std::max(10.0 * damping_, 0.1);
      return damping_ <= 1e6;
    }
  }
  damping_ = std::max(0.1 * damping_, 1e-6);
  is_converged_ = Decrement(at_) < kNegligibleDecrement &&
                  std::abs(mixture.scale - mode_->mixture.scale) < 2e-3 * mixture.scale;
  mode_->pose = pose;
  mode_->mixture = mixture;
  at_ = there;
  return true;
}

bool ModeFit::Finish() {
  const Eigen::LLT<Matrix5d> llt(at_.hessian);
  if (llt.info() != Eigen::Success) return false;
  mode_->log_likelihood = at_.log_likelihood;
  mode_->hessian = at_.hessian;
  mode_->inverse_hessian = llt.solve(Matrix5d::Identity());
  return Decrement(at_) < kSmallDecrement && mode_->inverse_hessian.allFinite();
}

bool FitMode(const MatchBlocks& matches, const MixturePrior& prior, int max_steps, Mode* mode,
             MixtureUpdate update) {
  ModeFit fit(matches, prior, mode, update);
  for (int step = 0; step < max_steps && !fit.is_converged(); ++step) {
    if (!fit.Step()) return false;
  }
  return fit.Finish();
}

void FitShares(const MatchBlocks& matches, const MixturePrior& prior, Mode* mode) {
  constexpr int kSteps = 5;
  MixturePrior fixed = prior;
  fixed.estimates_scale = false;
  mode->mixture.inlier_ratio = 0.5;
  mode->mixture = FitMixture(matches, fixed, mode->pose, mode->mixture, kSteps);
}

MixtureParameters FitMixture(const MatchBlocks& matches, const MixturePrior& prior, const RelativePose& pose,
                             MixtureParameters start, int num_steps) {
  for (int step = 0; step < num_steps; ++step)
    start = Updated(start, SumMixture(matches, matches.All(), pose, start), matches.num_matches(), prior);
  return start;
}

}  // namespace rcme
