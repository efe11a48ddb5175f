#include "estimator/refine_winner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/motion_chance.h"
#include "estimator/observability.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

void RefuseByChance(const MotionProblem& problem, const MatchBlocks& matches, const RansacOptions& options,
                    MotionEstimate* estimate) {
  const double level = options.ChanceLevelOrDefault();
  if (level == 1.0) return;
  const double chance = ChanceOfAgreement(problem, matches, estimate->cam2_from_cam1,
                                          ConsistencyThreshold(options.significance_level));
  if (LogFalseAlarms(kMotions, matches.num_matches(), estimate->num_explained, chance) <= std::log(level))
    return;
  estimate->status = MotionStatus::kNotBetterThanChance;
  estimate->message = fmt::format(
      "{} of {} matches agree with the motion; of random matches {:.1f} would agree with any one motion, and "
      "as many as that with the best of all",
      estimate->num_explained, matches.num_matches(), chance * matches.num_matches());
}

void DropDirection(MotionEstimate* estimate) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Matrix3d rotation_cov = estimate->pose_cov.topLeftCorner<3, 3>();
  estimate->status = MotionStatus::kDirectionNotObservable;
  estimate->cam2_from_cam1.t.setConstant(kNaN);
  estimate->pose_cov.setConstant(kNaN);
  estimate->pose_cov.topLeftCorner<3, 3>() = rotation_cov;
}

void KeepRotationAlone(const RotationTest& test, MotionEstimate* estimate) {
  estimate->cam2_from_cam1.R = test.rotation.R;
  estimate->pose_cov.topLeftCorner<3, 3>() = test.rotation.rotation_cov;
  DropDirection(estimate);
  const int num_fitted = CountIn(test.rotation.fitted);
  estimate->message = fmt::format(
      "a rotation alone explains {} of the {} matches that agree (sum of squares {:.0f}, {} expected of "
      "noise): "
      "no parallax beyond the noise, hence no direction",
      num_fitted, test.num_agreeing, test.rotation.energy, 2 * num_fitted - 3);
}

void RefuseNoisyDirection(const MatchBlocks& matches, MotionEstimate* estimate) {
  const double share = NoiseShareOfDirection(matches, estimate->inliers, estimate->cam2_from_cam1,
                                             estimate->pose_cov.bottomRightCorner<2, 2>());
  if (share <= kMostNoiseInDirection) return;
  DropDirection(estimate);
  estimate->message = fmt::format(
      "the parallax is too small against the noise: {:.0f} % of what seems to determine the direction is "
      "noise",
      100.0 * std::min(share, 1.0));
}

}  // namespace

double ConsistencyThreshold(double significance_level) {
  return ChiSquareQuantile(2, 1.0 - significance_level);
}

void RefuseByMotionTests(const MotionProblem& problem, const MatchBlocks& matches,
                         const RansacOptions& options, MotionEstimate* estimate) {
  RefuseByChance(problem, matches, options, estimate);
  const double level = options.ObservabilityLevelOrDefault();
  if (level == 1.0 || estimate->status != MotionStatus::kOk) return;
  const RotationTest test = TestRotationAlone(problem, matches, estimate->cam2_from_cam1, level);
  if (test.explains_matches) {
    KeepRotationAlone(test, estimate);
  } else {
    RefuseNoisyDirection(matches, estimate);
  }
}

void ExplainDivergence(const MotionProblem& problem, const MatchBlocks& matches, const RansacOptions& options,
                       const RelativePose& start, const MatchMask& support, MotionEstimate* estimate) {
  const double level = options.ObservabilityLevelOrDefault();
  if (level == 1.0) return;
  const RotationTest test = TestRotationAloneFrom(problem, matches, start, support, level);
  if (test.explains_matches) KeepRotationAlone(test, estimate);
}

std::string DivergenceMessage(int num_support, int num_fitted) {
  return fmt::format("the refinement, begun with {} matches, was left with {} and no finite optimum",
                     num_support, num_fitted);
}

std::string SuccessMessage(int num_inliers, int num_matches) {
  return fmt::format("motion from {} of {} matches", num_inliers, num_matches);
}

}  // namespace rcme
