// The parts of a call of the RANSAC family: check, loop, cheirality, refinement.
#pragma once

#include "estimator/hypothesis_trace.h"
#include "estimator/kernels/block_matches.h"
#include "estimator/kernels/block_search.h"
#include "estimator/reference_matches.h"
#include "estimator/reference_search.h"
#include "estimator/refine_winner.h"

namespace rcme {

// The check before any hypothesis is drawn; a refusal, or nothing.
std::optional<MotionEstimate> RefuseBeforeLoop(const MotionProblem& problem);

// What the loop says of its winner, or why there is none.
MotionEstimate EstimateFromLoop(const LoopResult& loop);

// An engine makes the hypotheses (search, see ransac_loop.h) and holds the matches for the refinement
// (matches, see refine_winner.h).
template <typename Pipeline>
struct ReferenceEngine {
  ReferenceEngine(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng)
      : search(problem, options, rng), matches(problem, options.refinement_error) {}
  ReferenceSearch<Pipeline> search;
  ReferenceMatches matches;
};

template <typename Pipeline>
struct FastEngine {
  using PointTest = typename Pipeline::PointTest;
  static constexpr BlockSearch::Reading kReading =
      std::is_same_v<PointTest, KnownPoseTest>   ? BlockSearch::Reading::kKnownPose
      : std::is_same_v<PointTest, RankAwareTest> ? BlockSearch::Reading::kRankAware
                                                 : BlockSearch::Reading::kAsPrinted;
  FastEngine(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng)
      : blocks(problem),
        search(problem, blocks, options,
               {kReading, Pipeline::kTestsSample, options.selection == Selection::kPredictiveLikelihood},
               rng),
        matches(problem, blocks, options.refinement_error) {}
  MatchBlocks blocks;
  BlockSearch search;
  BlockMatches matches;
};

template <typename Engine>
MotionEstimate FinishLoop(Engine& engine, const RansacOptions& options, const LoopResult& loop) {
  MotionEstimate estimate = EstimateFromLoop(loop);
  if (!loop.winner) return estimate;
  const Sample& sample = loop.winner->sample;
  RefineWinner(engine.matches, options, sample, engine.search.FindSupport(sample), &estimate);
  return estimate;
}

template <typename Pipeline, typename Engine = ReferenceEngine<Pipeline>>
MotionEstimate RunPipeline(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng) {
  if (std::optional<MotionEstimate> refusal = RefuseBeforeLoop(problem)) return *refusal;
  Engine engine(problem, options, rng);
  const auto num_matches = static_cast<int>(problem.matches.size());
  const LoopResult loop = RunRansacLoop<Pipeline>(options, num_matches, engine.search);
  return FinishLoop(engine, options, loop);
}

template <typename Engine>
HypothesisTrace TracePipeline(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng) {
  if (RefuseBeforeLoop(problem)) return {};
  Engine engine(problem, options, rng);
  return TraceHypotheses(options.num_iterations, static_cast<int>(problem.matches.size()), engine.search);
}

template <typename Engine>
MotionEstimate FinishPipeline(const MotionProblem& problem, const RansacOptions& options,
                              const LoopResult& loop) {
  if (std::optional<MotionEstimate> refusal = RefuseBeforeLoop(problem)) return *refusal;
  if (!loop.winner) return EstimateFromLoop(loop);
  RandomStream no_samples({0, 0, 0, 0});
  Engine engine(problem, options, no_samples);
  return FinishLoop(engine, options, loop);
}

}  // namespace rcme
