#include "estimator/ransac_estimate.h"

#include <fmt/format.h>

namespace rcme {

MotionEstimate EstimateFromCandidate(const LoopCounts& counts, const Candidate& candidate) {
  MotionEstimate estimate;
  estimate.counts = counts;
  estimate.hypothesis = candidate.id;
  estimate.num_support = candidate.score.num_inliers;
  estimate.mean_entropy = candidate.score.mean_entropy;
  estimate.z_statistic = candidate.z_statistic;
  return estimate;
}

MotionEstimate RefusalFromLoop(const LoopCounts& counts) {
  MotionEstimate estimate;
  estimate.counts = counts;
  const bool all_degenerate = counts.num_degenerate_samples == counts.num_hypotheses;
  estimate.status = all_degenerate ? MotionStatus::kDegenerateMatches : MotionStatus::kNoCandidate;
  estimate.message =
      all_degenerate
          ? fmt::format("no motion could be computed: all {} samples are degenerate", counts.num_hypotheses)
          : fmt::format(
                "none of the {} hypotheses is a candidate: {} samples are degenerate, {} hypotheses disagree "
                "with their sample, {} fail the inlier quality test",
                counts.num_hypotheses, counts.num_degenerate_samples, counts.num_inconsistent_samples,
                counts.num_poor_inlier_sets);
  return estimate;
}

void CheckExplainedShare(const RansacOptions& options, int num_matches, MotionEstimate* estimate) {
  if (estimate->status != MotionStatus::kOk) return;
  const double least = options.least_explained_share * num_matches;
  if (estimate->num_explained >= least * (1.0 - 1e-12)) return;  // 0.55 * 100 rounds to more than 55
  estimate->status = MotionStatus::kTooFewExplained;
  estimate->message = fmt::format("the motion explains {} of {} matches, less than the required share {}",
                                  estimate->num_explained, num_matches, options.least_explained_share);
}

}  // namespace rcme
