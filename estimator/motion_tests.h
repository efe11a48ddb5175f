// Tests that refuse a refined motion: because chance explains as many matches (motion_chance.h), or because
// its direction is not observable (observability.h).
#pragma once

#include "estimator/motion_estimate.h"
#include "estimator/observability.h"
#include "estimator/ransac_options.h"

namespace rcme {

// The threshold of "reprojection error consistent", chi2_2(1 - alpha) (Sec. metric). The error is the squared
// Sampson distance, the first-order minimum over the point. Huber's function would not change the verdict as
// long as its corner lies at or beyond the threshold.
double ConsistencyThreshold(double significance_level);

// Refuses a motion if chance explains num_explained agreeing matches. `chance`: the probability that a random
// match agrees.
void RefuseByChance(int num_matches, double chance, double significance_level, MotionEstimate* estimate);

// Refuses a direction if the `share` of noise in its information (NoiseShareOfDirection) is too large; the
// direction and its covariance become NaN.
void RefuseNoisyDirection(double share, MotionEstimate* estimate);

// Refuses the direction and replaces the rotation by the best pure rotation.
void KeepRotationAlone(const RotationTest& test, MotionEstimate* estimate);

// Runs all three tests; num_explained must be filled. `Matches`: see refine_winner.h.
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

// Call this after a refinement from `start` has diverged. If a pure rotation explains the matches, lack of
// parallax is the reason, and the estimate becomes that rotation.
template <typename Matches>
void ExplainDivergence(const Matches& matches, const RansacOptions& options, const RelativePose& start,
                       const typename Matches::Set& support, MotionEstimate* estimate) {
  const double level = options.ObservabilityLevelOrDefault();
  if (level == 1.0) return;
  const RotationTest test = TestRotationAloneFrom(matches, start, support, level);
  if (test.explains_matches) KeepRotationAlone(test, estimate);
}

}  // namespace rcme
