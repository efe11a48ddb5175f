// One call of an estimator of the RANSAC family: check, loop, cheirality, refinement.
#pragma once

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

template <typename Pipeline>
MotionEstimate RunReferencePipeline(const MotionProblem& problem, const RansacOptions& options,
                                    RandomStream& rng) {
  if (std::optional<MotionEstimate> refusal = RefuseBeforeLoop(problem)) return *refusal;
  ReferenceSearch<Pipeline> search(problem, options, rng);
  const LoopResult loop = RunRansacLoop<Pipeline>(options, static_cast<int>(problem.matches.size()), search);
  MotionEstimate estimate = EstimateFromLoop(loop);
  if (!loop.winner) return estimate;
  const Sample& sample = loop.winner->sample;
  RefineWinner(ReferenceMatches(problem, options.refinement_error), options, sample,
               search.FindSupport(sample), &estimate);
  return estimate;
}

template <typename Pipeline>
MotionEstimate RunFastPipeline(const MotionProblem& problem, const RansacOptions& options,
                               RandomStream& rng) {
  using PointTest = typename Pipeline::PointTest;
  constexpr BlockSearch::Reading kReading =
      std::is_same_v<PointTest, KnownPoseTest>   ? BlockSearch::Reading::kKnownPose
      : std::is_same_v<PointTest, RankAwareTest> ? BlockSearch::Reading::kRankAware
                                                 : BlockSearch::Reading::kAsPrinted;
  if (std::optional<MotionEstimate> refusal = RefuseBeforeLoop(problem)) return *refusal;
  const MatchBlocks matches(problem);
  BlockSearch search(
      problem, matches, options,
      {kReading, Pipeline::kTestsSample, options.selection == Selection::kPredictiveLikelihood}, rng);
  const LoopResult loop = RunRansacLoop<Pipeline>(options, matches.num_matches(), search);
  MotionEstimate estimate = EstimateFromLoop(loop);
  if (!loop.winner) return estimate;
  const Sample& sample = loop.winner->sample;
  RefineWinner(BlockMatches(problem, matches, options.refinement_error), options, sample,
               search.FindSupport(sample), &estimate);
  return estimate;
}

template <typename Pipeline>
MotionEstimate RunPipeline(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng) {
  return options.implementation == Implementation::kFast
             ? RunFastPipeline<Pipeline>(problem, options, rng)
             : RunReferencePipeline<Pipeline>(problem, options, rng);
}

}  // namespace rcme
