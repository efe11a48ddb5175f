// Step 2 of rcme_calibrated: from hypotheses to modes.
#pragma once

#include <vector>

#include "estimator/calibrated/hypothesis_search.h"
#include "estimator/calibrated/mixture_fit.h"

namespace rcme {

// The one of the four poses of E that puts the matches most clearly in front of both cameras (SumCheirality).
RelativePose PoseInFront(const MatchBlocks& matches, const Eigen::Matrix3d& E);

// The mask of the first `count` matches, a multiple of kBlockSize.
MatchMask TakeFirst(const MatchBlocks& matches, size_t count);

// Refines the candidates to modes and returns at most `num_modes` of them, most likely first; where there is
// little parallax, at most three more:
// 1. Each candidate is refined by a few steps at a wide scale on the first matches.
// 2. The best distinct ones are refined to their optimum on all matches. Half of them are ranked at the
//    assumed scale. If sigma is estimated, the other half are ranked at the wide scale and start at the scale
//    that fits them best. A fit that reaches a known mode is dropped, and so is one that does not converge,
//    unless it is more likely than every optimum.
// 3. Where a fifth or less of the matches of some mode have a parallax above six standard deviations of its
//    noise, the best three candidates are refined on all matches as they are, too.
//
// If no candidate has an optimum, returns the best one after a few steps; if no Hessian can be inverted,
// returns nothing.
std::vector<Mode> FindModes(const MatchBlocks& matches, const MixturePrior& prior,
                            const std::vector<ScoredEssential>& candidates, size_t num_modes);

// The optima reached from these motions on all matches, without duplicates, and a fit that did not converge
// if it is more likely than all of them. Each fit starts at the assumed scale and, if sigma is estimated,
// also at the scale that fits its start best.
std::vector<Mode> ModesFrom(const MatchBlocks& matches, const MixturePrior& prior,
                            const std::vector<RelativePose>& starts);

// Whether b lies within this many standard deviations of a, by the Hessian of a.
bool IsSameMode(const Mode& a, const Mode& b, double standard_deviations = 5.0);

}  // namespace rcme
