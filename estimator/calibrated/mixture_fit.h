// Step 2 of rcme_calibrated: maximises the likelihood over the motion and the mixture. Levenberg-Marquardt
// steps of the motion alternate with expectation-maximisation steps of the scale, the share and the density
// of outliers.
#pragma once

#include "estimator/calibrated/mode.h"
#include "estimator/kernels/mixture_sums.h"
#include "estimator/motion_prior.h"

namespace rcme {

// Knowledge besides the matches.
struct MixturePrior {
  // 1 / L, where L is half the diagonal of image 2 in units of the assumed sigma
  double uniform_density = 1e-3;
  bool estimates_scale = true;
  const MotionPrior* motion = nullptr;  // null: no prior of the motion
};

// SumMixture over the matches. If there is a prior of the motion, it is included in log_likelihood, gradient
// and hessian.
MixtureSums SumPosterior(const MatchBlocks& matches, const MatchMask& mask, const MixturePrior& prior,
                         const RelativePose& pose, const MixtureParameters& parameters);
// Its gradient alone and its log_likelihood alone, with the same bits in less time.
Vector5d SumPosteriorGradient(const MatchBlocks& matches, const MatchMask& mask, const MixturePrior& prior,
                              const RelativePose& pose, const MixtureParameters& parameters);
double SumLogPosterior(const MatchBlocks& matches, const MatchMask& mask, const MixturePrior& prior,
                       const RelativePose& pose, const MixtureParameters& parameters);

// Whether a fit changes the mixture, too (its scale only if MixturePrior::estimates_scale).
enum class MixtureUpdate { kNone, kAll };

MixtureParameters FirstGuess(const MixturePrior& prior, double scale, double inlier_ratio);

// A fit, step by step. Each step updates the motion and the mixture of the mode; only Finish updates its
// likelihood and Hessian.
class ModeFit {
 public:
  ModeFit(const MatchBlocks& matches, const MixturePrior& prior, Mode* mode,
          MixtureUpdate update = MixtureUpdate::kAll);
  // Returns false if no further step is possible; then the mode must not be used.
  bool Step();
  // Whether the last step began within 0.02 standard deviations of the optimum, by the gradient and the
  // Hessian without damping, and changed the scale by less than 0.2 %.
  bool is_converged() const { return is_converged_; }
  // Returns whether the fit converged: the optimum is within one standard deviation, and the Hessian can be
  // inverted.
  bool Finish();

 private:
  const MatchBlocks& matches_;
  const MixturePrior& prior_;
  Mode* mode_;
  MixtureUpdate update_;
  int num_used_;
  MixtureSums at_;
  double damping_ = 1e-3;
  bool is_converged_ = false;
};

// Takes steps until it has converged, at most `max_steps`. Returns false if a step fails, else what Finish
// returns.
bool FitMode(const MatchBlocks& matches, const MixturePrior& prior, int max_steps, Mode* mode,
             MixtureUpdate update = MixtureUpdate::kAll);

// Fits the share of inliers and the density of outliers at the mode's motion and scale, on all matches, used
// by the mode or not.
void FitShares(const MatchBlocks& matches, const MixturePrior& prior, Mode* mode);

// The mixture of all matches under a fixed motion after `num_steps` steps of expectation-maximisation.
MixtureParameters FitMixture(const MatchBlocks& matches, const MixturePrior& prior, const RelativePose& pose,
                             MixtureParameters start, int num_steps);

}  // namespace rcme
