// Step 2 of rcme_calibrated: from hypotheses to modes.
#pragma once

#include <vector>

#include "estimator/calibrated/hypothesis_search.h"
#include "estimator/calibrated/mixture_fit.h"

namespace rcme {

// The pose of an essential matrix for which the matches lie most clearly in front of both cameras
// (SumCheirality).
RelativePose PoseInFront(const MatchBlocks& matches, const Eigen::Matrix3d& E);

// Every candidate is refined by a few steps; those that reach a known mode are dropped, and the best
// `num_modes` go to their optimum. The most likely first; empty where none converges.
std::vector<Mode> FindModes(const MatchBlocks& matches, const MixturePrior& prior,
                            const std::vector<ScoredEssential>& candidates, size_t num_modes);

// Whether two modes are one: within so many standard deviations of the first, by its information.
bool IsSameMode(const Mode& a, const Mode& b, double standard_deviations = 5.0);

}  // namespace rcme
