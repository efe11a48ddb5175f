// Step 3 of rcme_calibrated: one outlier with a large apparent parallax may determine a fit. So the fit
// without a match of large leverage is a mode of its own.
#pragma once

#include <vector>

#include "estimator/calibrated/explanation.h"
#include "estimator/calibrated/mixture_fit.h"

namespace rcme {

inline constexpr double kLargeLeverage = 0.25;

// The converged fits without matches of leverage above kLargeLeverage: one fit without each of the
// three largest, then one without all of these.
std::vector<Mode> LeverageBranches(const MatchBlocks& matches, const MixturePrior& prior, const Mode& mode,
                                   const Explanation& explanation);

}  // namespace rcme
