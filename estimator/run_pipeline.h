// The parts of a call of the RANSAC family: check, loop, cheirality, refinement.
//
// An engine makes the hypotheses (`search`, see ransac_loop.h) and holds the matches for the refinement
// (`matches`, see refine_winner.h): reference_engine.h or kernels/fast_engine.h.
#pragma once

#include "estimator/hypothesis_trace.h"
#include "estimator/problem_check.h"
#include "estimator/ransac_estimator.h"
#include "estimator/reference_engine.h"
#include "estimator/refine_winner.h"

namespace rcme {

// What the loop says of a candidate.
MotionEstimate EstimateFromCandidate(const LoopCounts& counts, const Candidate& candidate);

// Why the loop has no candidate.
MotionEstimate RefusalFromLoop(const LoopCounts& counts);

// Refuses an estimate that explains too few of `num_matches`.
void CheckExplainedShare(const RansacOptions& options, int num_matches, MotionEstimate* estimate);

// The check before any hypothesis is drawn; a refusal, or nothing. The points of one image must not lie on
// one line whatever the solver: the refinement moves all five degrees of freedom.
template <typename Engine>
std::optional<MotionEstimate> RefuseBeforeLoop(const MotionProblem& problem) {
  return RefuseUnsolvable(problem, Engine::Solver::kSampleSize);
}

// The estimate from one candidate, before others are looked at.
template <typename Engine>
MotionEstimate RefineCandidate(Engine& engine, const RansacOptions& options, const LoopCounts& counts,
                               const Candidate& candidate) {
  MotionEstimate estimate = EstimateFromCandidate(counts, candidate);
  RefineWinner(engine.matches, options, engine.search.FindHypothesis(candidate.id),
               engine.search.FindSupport(candidate.id), &estimate);
  return estimate;
}

// The winner refined, or of several candidates the one that explains most matches, the better one first at a
// tie. `refine` makes the estimate from a candidate.
template <typename Refine>
MotionEstimate FinishLoop(const RansacOptions& options, int num_matches, const LoopResult& loop,
                          const Refine& refine) {
  if (!loop.winner) return RefusalFromLoop(loop.counts);
  MotionEstimate best = refine(*loop.winner);
  for (const Candidate& candidate : loop.runners_up) {
    MotionEstimate estimate = refine(candidate);
    if (estimate.num_explained > best.num_explained) best = std::move(estimate);
  }
  CheckExplainedShare(options, num_matches, &best);
  return best;
}

template <typename Pipeline, typename Engine>
MotionEstimate RunEngine(const MotionProblem& problem, const RansacOptions& options, Engine& engine) {
  const auto num_matches = static_cast<int>(problem.matches.size());
  const LoopResult loop = RunRansacLoop<Pipeline>(options, num_matches, engine.search);
  return FinishLoop(options, num_matches, loop, [&](const Candidate& candidate) {
    return RefineCandidate(engine, options, loop.counts, candidate);
  });
}

template <typename Pipeline, typename Engine>
MotionEstimate RunPipeline(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng) {
  if (std::optional<MotionEstimate> refusal = RefuseBeforeLoop<Engine>(problem)) return *refusal;
  Engine engine(problem, options, rng);
  return RunEngine<Pipeline>(problem, options, engine);
}

template <typename Engine>
HypothesisTrace TracePipeline(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng) {
  if (RefuseBeforeLoop<Engine>(problem)) return {};
  Engine engine(problem, options, rng);
  return TraceHypotheses(options.num_iterations, static_cast<int>(problem.matches.size()), engine.search);
}

// See RansacEstimator::Finish.
template <typename Engine>
MotionEstimate FinishPipeline(const MotionProblem& problem, const RansacOptions& options,
                              const LoopResult& loop, Refinements* refinements) {
  if (!loop.winner) {
    if (std::optional<MotionEstimate> refusal = RefuseBeforeLoop<Engine>(problem)) return *refusal;
  }
  RandomStream no_samples({0, 0, 0, 0});
  std::optional<Engine> engine;  // made when the first refinement is missing
  const auto refine = [&](const Candidate& candidate) {
    const auto known = refinements->find(candidate.id);
    if (known == refinements->end()) {
      if (!engine) engine.emplace(problem, options, no_samples);
      return (*refinements)[candidate.id] = RefineCandidate(*engine, options, loop.counts, candidate);
    }
    MotionEstimate estimate = known->second;
    estimate.counts = loop.counts;  // these two depend on how the loop decided
    estimate.z_statistic = candidate.z_statistic;
    return estimate;
  };
  return FinishLoop(options, static_cast<int>(problem.matches.size()), loop, refine);
}

}  // namespace rcme
