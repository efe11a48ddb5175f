// Step 3 of rcme_calibrated: one wrong match with a large apparent parallax may own a fit. For every match of
// large influence, the fit without it is a mode of its own.
#pragma once

#include <vector>

#include "estimator/calibrated/explanation.h"
#include "estimator/calibrated/mixture_fit.h"

namespace rcme {

inline constexpr double kLargeLeverage = 0.25;
inline constexpr size_t kMostBranches = 3;

// The converged fits without the matches of leverage above kLargeLeverage: each of the kMostBranches largest,
// then all of these together.
std::vector<Mode> LeverageBranches(const MatchBlocks& matches, const MixturePrior& prior, const Mode& mode,
                                   const Explanation& explanation);

}  // namespace rcme
