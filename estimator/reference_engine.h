#pragma once

#include "estimator/reference_matches.h"
#include "estimator/reference_search.h"

namespace rcme {

// `implementation: reference`, all of it one sample and one match at a time: the oracle of
// kernels/fast_engine.h, with no code of the kernels in it. See ransac_estimate.h.
template <RansacDecision Decision, typename SolverT>
struct ReferenceEngine {
  using Solver = SolverT;
  ReferenceEngine(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng)
      : search(problem, options, rng), matches(problem, options.refinement_error) {}
  ReferenceSearch<Decision, Solver> search;
  ReferenceMatches matches;
};

}  // namespace rcme
