// Step 7 of rcme_calibrated where the parallax is hardly more than the noise.
#pragma once

#include <optional>

#include "estimator/calibrated/direction_posterior.h"

namespace rcme {

// Where fewer than a fifth of the matches have a parallax of six standard deviations of its noise
// (UsualDepthInNoise) the direction is not normal: the probability, over the whole sphere, that it lies
// within `angle_rad` of the answer's. If that is below .8, the answer is moved to the optimum near the most
// likely direction, provided that this is more probable. Elsewhere nothing, and the answer stays; likewise
// where a prior determines the direction to half of that angle, so that it is normal.
std::optional<double> SettleDirection(const MotionProblem& problem, const MatchBlocks& matches,
                                      const MixturePrior& prior, double angle_rad, ExplainedMode* answer);

}  // namespace rcme
