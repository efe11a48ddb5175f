#pragma once

#include "estimator/reference_matches.h"
#include "estimator/reference_search.h"

namespace rcme {

// `implementation: reference`, an engine (ransac_estimate.h) that works on one sample and one match at a
// time. It is the oracle of kernels/fast_engine.h and shares no code with the kernels.
template <RansacDecision Decision, typename SolverT>
struct ReferenceEngine {
  using Solver = SolverT;
  ReferenceEngine(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng)
      : search(problem, options, rng), matches(problem, options.refinement_error) {}
  ReferenceSearch<Decision, Solver> search;
  ReferenceMatches matches;
};

}  // namespace rcme
