// Step 2 of rcme_calibrated: a mode with a noise level far above the assumed one may be a compromise between
// two motions, the camera's and that of an object, and explain the matches of both.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "estimator/calibrated/mixture_fit.h"
#include "estimator/motion_problem.h"
#include "stats/random.h"

namespace rcme {

// Two motions at the assumed noise level, if a mixture of both is more likely than `mode` alone: the first
// from samples of all matches, the second from samples of those that the first does not explain. Each is at
// its optimum by the matches that the other does not explain better.
std::optional<std::pair<Mode, Mode>> SplitMode(const MotionProblem& problem, const MatchBlocks& matches,
                                               const MixturePrior& prior, const Mode& mode,
                                               RandomStream& rng);

// Where the most likely of the modes, the first, has more than 1.15 times the assumed noise level and can be
// split: the two motions in place of all modes that are as much noisier than these.
void SplitCompromise(const MotionProblem& problem, const MatchBlocks& matches, const MixturePrior& prior,
                     std::vector<Mode>* modes, RandomStream& rng);

}  // namespace rcme
