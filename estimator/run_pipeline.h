#pragma once

#include <fmt/format.h>

#include "estimator/problem_check.h"
#include "estimator/ransac_loop.h"
#include "estimator/refine_winner.h"

namespace rcme {

// One call of an estimator: check, loop, cheirality, refinement.
template <typename Pipeline>
MotionEstimate RunPipeline(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng) {
  if (std::optional<MotionEstimate> refusal = RefuseUnsolvable(problem, EightPoint::kSampleSize))
    return *refusal;
  const LoopResult loop = RunRansacLoop<Pipeline>(problem, options, rng);
  MotionEstimate estimate;
  estimate.counts = loop.counts;
  if (!loop.winner) {
    const bool all_degenerate = loop.counts.num_degenerate_samples == loop.counts.num_hypotheses;
    estimate.status = all_degenerate ? MotionStatus::kDegenerateMatches : MotionStatus::kNoCandidate;
    estimate.message =
        all_degenerate
            ? fmt::format("none of {} samples determines a motion", loop.counts.num_hypotheses)
            : fmt::format(
                  "no hypothesis of {} is a candidate: {} degenerate, {} disagree with their sample, "
                  "{} have poor inliers",
                  loop.counts.num_hypotheses, loop.counts.num_degenerate_samples,
                  loop.counts.num_inconsistent_samples, loop.counts.num_poor_inlier_sets);
    return estimate;
  }
  estimate.num_support = loop.winner->score.num_inliers;
  estimate.mean_entropy = loop.winner->score.mean_entropy;
  estimate.z_statistic = loop.winner->z_statistic;

  // The winner again, now with its inliers and its covariance.
  using PointTest = typename Pipeline::PointTest;
  Hypothesis winner = InstantiateModel(problem, loop.winner->sample).value();
  PropagateCovariance(problem, &winner);
  const PointTest test = MakePointTest<PointTest>(problem, &winner).value();
  const Thresholds thresholds = Thresholds::For(problem, options, PointTest::kDegreesOfFreedom);
  const std::vector<int> support = FindInliers(problem, test, thresholds.point);
  std::vector<Correspondence> support_matches;
  for (const int index : support) support_matches.push_back(problem.matches[static_cast<size_t>(index)]);
  ResolveCheirality(problem, support_matches, &winner);
  RefineWinner(problem, options, winner, support, &estimate);
  return estimate;
}

}  // namespace rcme
