#include "estimator/run_pipeline.h"

#include <fmt/format.h>

#include "estimator/problem_check.h"

namespace rcme {

std::optional<MotionEstimate> RefuseBeforeLoop(const MotionProblem& problem) {
  return RefuseUnsolvable(problem, EightPoint::kSampleSize);
}

MotionEstimate EstimateFromLoop(const LoopResult& loop) {
  MotionEstimate estimate;
  estimate.counts = loop.counts;
  if (loop.winner) {
    estimate.num_support = loop.winner->score.num_inliers;
    estimate.mean_entropy = loop.winner->score.mean_entropy;
    estimate.z_statistic = loop.winner->z_statistic;
    return estimate;
  }
  const LoopCounts& counts = loop.counts;
  const bool all_degenerate = counts.num_degenerate_samples == counts.num_hypotheses;
  estimate.status = all_degenerate ? MotionStatus::kDegenerateMatches : MotionStatus::kNoCandidate;
  estimate.message =
      all_degenerate
          ? fmt::format("none of {} samples determines a motion", counts.num_hypotheses)
          : fmt::format(
                "no hypothesis of {} is a candidate: {} degenerate, {} disagree with their sample, "
                "{} have poor inliers",
                counts.num_hypotheses, counts.num_degenerate_samples, counts.num_inconsistent_samples,
                counts.num_poor_inlier_sets);
  return estimate;
}

}  // namespace rcme
