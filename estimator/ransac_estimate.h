// A call of the RANSAC family, the body of Estimate: check the problem, run the loop, refine the winner.
#pragma once

#include <concepts>
#include <optional>
#include <utility>

#include "estimator/problem_check.h"
#include "estimator/ransac_loop.h"
#include "estimator/reference_engine.h"
#include "estimator/refine_winner.h"

namespace rcme {

// An engine makes the hypotheses of one minimal solver (`search`), which can also reconstruct a hypothesis
// and its inliers from its id, and holds the matches for the refinement (`matches`). There are two:
// reference_engine.h and kernels/fast_engine.h.
template <typename T>
concept RansacEngine = requires(T engine, const HypothesisId& id) {
  requires HypothesisSolver<decltype(engine.search)> && HypothesisScorer<decltype(engine.search)>;
  requires MatchSets<decltype(engine.matches)>;
  { engine.search.thresholds() } -> std::same_as<const Thresholds&>;
  { engine.search.FindHypothesis(id) } -> std::same_as<std::optional<Hypothesis<typename T::Solver>>>;
  { engine.search.FindSupport(id) } -> std::convertible_to<typename decltype(engine.matches)::Set>;
};

// The fields of an estimate that the loop knows of a candidate.
MotionEstimate EstimateFromCandidate(const LoopCounts& counts, const Candidate& candidate);

// The refusal if the loop found no candidate.
MotionEstimate RefusalFromLoop(const LoopCounts& counts);

// Refuses an estimate that explains less than options.least_explained_share of `num_matches`.
void CheckExplainedShare(const RansacOptions& options, int num_matches, MotionEstimate* estimate);

// The check before any hypothesis is drawn: a refusal, or nullopt. It also refuses points of one image on one
// line, whatever the solver, because the refinement moves all five degrees of freedom.
template <RansacEngine Engine>
std::optional<MotionEstimate> RefuseBeforeLoop(const MotionProblem& problem) {
  return RefuseUnsolvable(problem, Engine::Solver::kSampleSize);
}

// The estimate refined from one candidate.
template <RansacEngine Engine>
MotionEstimate RefineCandidate(Engine& engine, const RansacOptions& options, const LoopCounts& counts,
                               const Candidate& candidate) {
  MotionEstimate estimate = EstimateFromCandidate(counts, candidate);
  RefineWinner(engine.matches, options, engine.search.FindHypothesis(candidate.id),
               engine.search.FindSupport(candidate.id), &estimate);
  return estimate;
}

// Refines the winner and the runners-up, and returns the estimate that explains most matches; of equal ones
// the candidate with the better score. `refine` makes the estimate from a candidate.
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

template <RansacDecision Decision, RansacEngine Engine>
MotionEstimate EstimateWith(const MotionProblem& problem, const RansacOptions& options, Engine& engine) {
  const auto num_matches = static_cast<int>(problem.matches.size());
  const Decision decision(options, engine.search.thresholds());
  const LoopResult loop = RunRansacLoop(options, num_matches, engine.search, engine.search, decision);
  return FinishLoop(options, num_matches, loop, [&](const Candidate& candidate) {
    return RefineCandidate(engine, options, loop.counts, candidate);
  });
}

template <RansacDecision Decision, RansacEngine Engine>
MotionEstimate EstimateByRansac(const MotionProblem& problem, const RansacOptions& options,
                                RandomStream& rng) {
  if (std::optional<MotionEstimate> refusal = RefuseBeforeLoop<Engine>(problem)) return *refusal;
  Engine engine(problem, options, rng);
  return EstimateWith<Decision>(problem, options, engine);
}

}  // namespace rcme
