// Step 2 of rcme_calibrated: splits a mode that explains the matches of two motions, the camera's and that of
// an object. Such a compromise shows by a noise level far above the assumed one.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "estimator/calibrated/mixture_fit.h"
#include "estimator/motion_problem.h"
#include "stats/random.h"

namespace rcme {

// Two motions at the assumed noise level, if their mixture is clearly more likely than `mode` alone. The
// first comes from samples of all matches, the second from samples of those that the first does not explain.
// Each is at its optimum on the matches that the other does not explain better.
std::optional<std::pair<Mode, Mode>> SplitMode(const MotionProblem& problem, const MatchBlocks& matches,
                                               const MixturePrior& prior, const Mode& mode,
                                               RandomStream& rng);

// If the first mode, the most likely one, has more than 1.15 times the assumed noise level and can be split:
// adds the two motions, and removes all modes whose noise level exceeds theirs by the same factor.
void SplitCompromise(const MotionProblem& problem, const MatchBlocks& matches, const MixturePrior& prior,
                     std::vector<Mode>* modes, RandomStream& rng);

}  // namespace rcme
