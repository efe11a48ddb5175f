// Step 2 of rcme_calibrated: the camera's motion beside an object with most of the matches, or an object's.
#pragma once

#include <vector>

#include "estimator/calibrated/mixture_fit.h"
#include "estimator/motion_problem.h"
#include "stats/random.h"

namespace rcme {

// If matches that the first mode clearly does not explain move as their neighbours do: adds the motion that
// explains most of those that no mode explains, at its optimum on all that the first mode does not explain.
// It has to explain a quarter of the former, and a dozen. The search over all matches often misses the
// smaller of two motions. With an object that has 60 % of the matches, 0.4^5 = 1 % of the samples lie on the
// scene, and the search may end after 64.
void AddSecondMotion(const MotionProblem& problem, const MatchBlocks& matches, const MixturePrior& prior,
                     std::vector<Mode>* modes, RandomStream& rng);

}  // namespace rcme
