// Step 2 of rcme_calibrated: a motion and its mixture at the optimum of the likelihood, by
// Levenberg-Marquardt steps of the motion between expectation-maximisation steps of the scale, the share and
// the density of wrong matches.
#pragma once

#include <limits>

#include "estimator/calibrated/mode.h"
#include "estimator/kernels/mixture_sums.h"

namespace rcme {

// What is known beside the matches.
struct MixturePrior {
  double uniform_density = 1e-3;  // 1 / L, L half the diagonal of image 2 in units of the assumed sigma
  bool estimates_scale = true;
};

// What a fit may change beside the motion: what the prior says, or nothing.
enum class MixtureUpdate { kNone, kAll };

MixtureParameters FirstGuess(const MixturePrior& prior, double scale, double inlier_ratio);

// A fit step by step. The mode's motion and mixture follow; its likelihood and Hessian only with Finish.
class ModeFit {
 public:
  ModeFit(const MatchBlocks& matches, const MixturePrior& prior, Mode* mode,
          MixtureUpdate update = MixtureUpdate::kAll);
  // False: no further step can be taken, and the mode is not to be used.
  bool Step();
  // The last step was negligible: below 0.02 standard deviations of the motion and 0.2 % of the scale.
  bool is_converged() const { return is_converged_; }
  // Whether the last step was below a standard deviation; a mode whose Hessian cannot be inverted does not
  // converge.
  bool Finish();

 private:
  const MatchBlocks& matches_;
  const MixturePrior& prior_;
  Mode* mode_;
  MixtureUpdate update_;
  int num_used_;
  MixtureSums at_;
  double damping_ = 1e-3;
  double decrement_ = std::numeric_limits<double>::infinity();
  bool is_converged_ = false;
};

// At most `max_steps` steps; fewer where one is negligible. Returns what Finish does.
bool FitMode(const MatchBlocks& matches, const MixturePrior& prior, int max_steps, Mode* mode,
             MixtureUpdate update = MixtureUpdate::kAll);

// The share and the density of wrong matches among all matches, whichever the mode uses, at its motion and
// scale.
void FitShares(const MatchBlocks& matches, const MixturePrior& prior, Mode* mode);

// Of all matches under a motion that stays: the mixture after so many steps of expectation-maximisation.
MixtureParameters FitMixture(const MatchBlocks& matches, const MixturePrior& prior, const RelativePose& pose,
                             MixtureParameters start, int num_steps);

}  // namespace rcme
