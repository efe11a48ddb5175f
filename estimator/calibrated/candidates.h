// Step 2 of rcme_calibrated: from hypotheses to modes.
#pragma once

#include <vector>

#include "estimator/calibrated/hypothesis_search.h"
#include "estimator/calibrated/mixture_fit.h"

namespace rcme {

// The pose of an essential matrix for which the matches lie most clearly in front of both cameras
// (SumCheirality).
RelativePose PoseInFront(const MatchBlocks& matches, const Eigen::Matrix3d& E);

// Every candidate is refined by a few steps at a wide scale on the first matches. The best distinct ones go
// to their optimum by all matches, half of them as ranked at the assumed scale, half (where sigma is
// estimated) as ranked at the wide one and begun at the scale that suits them; one that reaches a known mode
// is dropped. Returned are at most `num_modes`, the most likely first; where none has an optimum, the best
// after a few steps; none where no Hessian can be inverted.
std::vector<Mode> FindModes(const MatchBlocks& matches, const MixturePrior& prior,
                            const std::vector<ScoredEssential>& candidates, size_t num_modes);

// The optima that are reached from these motions by all matches, begun at the assumed scale and (where sigma
// is estimated) at the scale that suits them; each once.
std::vector<Mode> ModesFrom(const MatchBlocks& matches, const MixturePrior& prior,
                            const std::vector<RelativePose>& starts);

// Whether two modes are one: within so many standard deviations of the first, by its information.
bool IsSameMode(const Mode& a, const Mode& b, double standard_deviations = 5.0);

}  // namespace rcme
