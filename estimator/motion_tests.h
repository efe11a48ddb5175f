// Refusals of a refined motion: one that explains no more than chance does (motion_chance.h), or whose
// direction cannot be observed (observability.h).
#pragma once

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"
#include "estimator/observability.h"
#include "estimator/ransac_options.h"

namespace rcme {

// The threshold of "reprojection error consistent", chi2_2(1 - alpha) (Sec. metric). The error is the squared
// Sampson distance, its first-order minimum over the point; Huber's function does not change the verdict as
// long as its corner lies at or beyond the threshold.
double ConsistencyThreshold(double significance_level);

// Refuses a motion that no more of the matches agree with, `num_explained`, than chance gives. `chance`: that
// a random match does.
void RefuseByChance(int num_matches, double chance, double significance_level, MotionEstimate* estimate);

// Refuses a direction whose parallax is too small against its noise, `share` of its information: direction
// and its covariance are NaN.
void RefuseNoisyDirection(double share, MotionEstimate* estimate);

// Refuses the direction and puts the rotation of the best rotation alone in the place of the motion's.
void KeepRotationAlone(const RotationTest& test, MotionEstimate* estimate);

// All three. `num_explained` is known. `Matches`: see refine_winner.h.
template <typename Matches>
void RefuseByMotionTests(const Matches& matches, const RansacOptions& options, MotionEstimate* estimate) {
  const RelativePose pose = estimate->cam2_from_cam1;
  const double chance_level = options.ChanceLevelOrDefault();
  if (chance_level != 1.0) {
    const double chance = matches.ChanceOfAgreement(pose, ConsistencyThreshold(options.significance_level));
    RefuseByChance(static_cast<int>(matches.problem().matches.size()), chance, chance_level, estimate);
  }
  const double level = options.ObservabilityLevelOrDefault();
  if (level == 1.0 || estimate->status != MotionStatus::kOk) return;
  if (MayRotationExplain(matches, pose, level)) {
    const RotationTest test = TestRotationAlone(matches, pose, level);
    if (test.explains_matches) return KeepRotationAlone(test, estimate);
  }
  const Eigen::Matrix2d direction_cov = estimate->pose_cov.bottomRightCorner<2, 2>();
  const auto inliers = matches.MakeSet(estimate->inliers);
  RefuseNoisyDirection(
      NoiseShareOfDirection(direction_cov, matches.SumDirectionNoise(inliers, pose, direction_cov)),
      estimate);
}

// After a refinement that diverged from `start` and its matches: the rotation alone, if too little parallax
// is the reason.
template <typename Matches>
void ExplainDivergence(const Matches& matches, const RansacOptions& options, const RelativePose& start,
                       const typename Matches::Set& support, MotionEstimate* estimate) {
  const double level = options.ObservabilityLevelOrDefault();
  if (level == 1.0) return;
  const RotationTest test = TestRotationAloneFrom(matches, start, support, level);
  if (test.explains_matches) KeepRotationAlone(test, estimate);
}

}  // namespace rcme
