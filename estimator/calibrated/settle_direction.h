// Step 7 of rcme_calibrated if the parallax is hardly greater than the noise.
#pragma once

#include <optional>

#include "estimator/calibrated/direction_posterior.h"

namespace rcme {

struct WeakDirection {
  double mass_within = 0.0;  // probability that the direction is within the bound of the answer's
  Matrix5d covariance = Matrix5d::Zero();  // as DirectionPosterior's
};

// The direction is not normal if fewer than a fifth of the matches have a parallax above six standard
// deviations of its noise (UsualDepthInNoise). Then returns the probability, over the whole sphere, that the
// direction lies within `angle_rad` of the answer's. If that is at most .8, the answer is first moved to the
// optimum near the most likely direction, provided that this has a greater probability.
//
// Otherwise returns nullopt and leaves the answer; also if a prior determines the direction to half of
// `angle_rad`, so that it is normal.
std::optional<WeakDirection> SettleDirection(const MotionProblem& problem, const MatchBlocks& matches,
                                             const MixturePrior& prior, double angle_rad,
                                             ExplainedMode* answer);

}  // namespace rcme
