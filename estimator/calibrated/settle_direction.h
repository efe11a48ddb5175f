// Step 7 of rcme_calibrated if the parallax is hardly greater than the noise.
#pragma once

#include <optional>

#include "estimator/calibrated/direction_posterior.h"

namespace rcme {

// The direction is not normal if fewer than a fifth of the matches have a parallax above six standard
// deviations of its noise (UsualDepthInNoise). Then returns the probability, over the whole sphere, that the
// direction lies within `angle_rad` of the answer's. If that is at most .8, the answer is first moved to the
// optimum near the most likely direction, provided that this has a greater probability.
//
// Otherwise returns nullopt and leaves the answer; also if a prior determines the direction to half of
// `angle_rad`, so that it is normal.
std::optional<double> SettleDirection(const MotionProblem& problem, const MatchBlocks& matches,
                                      const MixturePrior& prior, double angle_rad, ExplainedMode* answer);

}  // namespace rcme
