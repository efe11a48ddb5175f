// A call of the RANSAC family: check, loop, refinement. The body of Estimate.
#pragma once

#include <concepts>
#include <optional>
#include <utility>

#include "estimator/problem_check.h"
#include "estimator/ransac_loop.h"
#include "estimator/reference_engine.h"
#include "estimator/refine_winner.h"

namespace rcme {

// Makes the hypotheses of one minimal solver (`search`), finds one of them again with its inliers, and holds
// the matches for the refinement (`matches`): reference_engine.h or kernels/fast_engine.h.
template <typename T>
concept RansacEngine = requires(T engine, const HypothesisId& id) {
  requires HypothesisSolver<decltype(engine.search)> && HypothesisScorer<decltype(engine.search)>;
  requires MatchSets<decltype(engine.matches)>;
  { engine.search.thresholds() } -> std::same_as<const Thresholds&>;
  { engine.search.FindHypothesis(id) } -> std::same_as<std::optional<Hypothesis<typename T::Solver>>>;
  { engine.search.FindSupport(id) } -> std::convertible_to<typename decltype(engine.matches)::Set>;
};

// What the loop says of a candidate.
MotionEstimate EstimateFromCandidate(const LoopCounts& counts, const Candidate& candidate);

// Why the loop has no candidate.
MotionEstimate RefusalFromLoop(const LoopCounts& counts);

// Refuses an estimate that explains too few of `num_matches`.
void CheckExplainedShare(const RansacOptions& options, int num_matches, MotionEstimate* estimate);

// The check before any hypothesis is drawn; a refusal, or nothing. The points of one image must not lie on
// one line whatever the solver: the refinement moves all five degrees of freedom.
template <RansacEngine Engine>
std::optional<MotionEstimate> RefuseBeforeLoop(const MotionProblem& problem) {
  return RefuseUnsolvable(problem, Engine::Solver::kSampleSize);
}

// The estimate from one candidate, before others are looked at.
template <RansacEngine Engine>
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
