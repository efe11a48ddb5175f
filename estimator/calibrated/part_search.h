// Searches the motion of a part of the matches, for a second motion beside that of the others.
#pragma once

#include <optional>
#include <vector>

#include "estimator/calibrated/explanation.h"
#include "estimator/calibrated/mixture_fit.h"
#include "estimator/motion_problem.h"
#include "stats/random.h"

namespace rcme {

inline constexpr int kPartSteps = 15;  // of a fit to a part

// The prior of a motion that need not be the camera's, at the assumed noise level.
MixturePrior MakePartPrior(const MixturePrior& prior);

// The matches that the mode does not explain.
std::vector<size_t> FindUnexplained(const Explanation& explanation);

// Makes a mode use these matches alone.
void UseOnly(const std::vector<size_t>& some, MatchMask* mask);

// Greatest numbers of samples and of candidates of a search.
struct SearchEffort {
  int max_samples, num_candidates;
};

// The best motion of some of the matches; `part_prior` is that of MakePartPrior. Samples are ranked and
// candidates refined at the assumed noise level: at a greater one, a compromise between two motions would
// win.
std::optional<Mode> SearchPart(const MotionProblem& problem, const MatchBlocks& matches,
                               const MixturePrior& part_prior, const std::vector<size_t>& some,
                               const SearchEffort& effort, RandomStream& rng);

}  // namespace rcme
