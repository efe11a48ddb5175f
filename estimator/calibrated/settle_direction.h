// Step 7 of rcme_calibrated if the parallax is hardly greater than the noise.
#pragma once

#include <optional>

#include "estimator/calibrated/calibrated_options.h"
#include "estimator/calibrated/direction_posterior.h"

namespace rcme {

struct WeakDirection {
  double mass_within = 0.0;  // probability that the direction is within the bound of the answer's
  Matrix5d covariance = Matrix5d::Zero();  // as DirectionPosterior's
};

// The direction is not normal if fewer than a fifth of the matches have a parallax above six standard
// deviations of its noise (UsualDepthInNoise). Then returns the probability, over the whole sphere, that the
// direction lies within `angle_rad` of the answer's. If that is at most .8, the answer is compared with the
// optimum near the most likely direction:
// - If the log-odds of the modes (ComputeLogOdds) prefer the answer, it stays. If the optimum is beyond
//   `angle_rad`, the odds divide the mass of the directions within `angle_rad` of either: the law of the
//   displacements knows neither the noise of each motion nor the usual ones.
// - Otherwise the answer moves there, provided that this has a greater probability.
//
// Of a normal direction returns nullopt and leaves the answer; also if a prior determines the direction to
// half of `angle_rad`, so that it is normal.
std::optional<WeakDirection> SettleDirection(const MotionProblem& problem, const MatchBlocks& matches,
                                             const MixturePrior& prior, double angle_rad,
                                             CalibratedStep leave_out, ExplainedMode* answer);

}  // namespace rcme
