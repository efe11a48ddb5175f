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

// If matches that the first mode clearly does not explain move as their neighbours do: adds the motion that
// explains most of those that no mode explains, at its optimum on all that the first mode does not explain.
// It has to explain a quarter of the former, and a dozen. The search over all matches often misses the
// smaller of two motions. With an object that has 60 % of the matches, 0.4^5 = 1 % of the samples lie on the
// scene, and the search may end after 64.
void AddSecondMotion(const MotionProblem& problem, const MatchBlocks& matches, const MixturePrior& prior,
                     std::vector<Mode>* modes, RandomStream& rng);

}  // namespace rcme
