#include "estimator/motion_tests.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimator/motion_chance.h"
#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

void DropDirection(MotionEstimate* estimate) {
  const Eigen::Matrix3d rotation_cov = estimate->pose_cov.topLeftCorner<3, 3>();
  estimate->status = MotionStatus::kDirectionNotObservable;
  estimate->cam2_from_cam1.t.setConstant(kNaN);
  estimate->pose_cov.setConstant(kNaN);
  estimate->pose_cov.topLeftCorner<3, 3>() = rotation_cov;
}

}  // namespace

double ConsistencyThreshold(double significance_level) {
  return ChiSquareQuantile(2, 1.0 - significance_level);
}

void RefuseByChance(int num_matches, double chance, double significance_level, MotionEstimate* estimate) {
  if (LogFalseAlarms(kMotions, num_matches, estimate->num_explained, chance) <= std::log(significance_level))
    return;
  estimate->status = MotionStatus::kNotBetterThanChance;
  estimate->message = fmt::format(
      "{} of {} matches agree with the motion, no more than chance explains: of random matches, {:.1f} agree "
      "with "
      "a given motion on average, and this many may agree with the best motion",
      estimate->num_explained, num_matches, chance * num_matches);
}

void KeepRotationAlone(const RotationTest& test, MotionEstimate* estimate) {
  estimate->cam2_from_cam1.R = test.rotation.R;
  estimate->pose_cov.topLeftCorner<3, 3>() = test.rotation.rotation_cov;
  DropDirection(estimate);
  const int num_fitted = test.rotation.num_fitted;
  estimate->message = fmt::format(
      "a rotation alone explains {} of the {} matches that agree (sum of squared residuals {:.0f}, {} "
      "expected "
      "from noise alone): no parallax beyond the noise, so the direction cannot be estimated",
      num_fitted, test.num_agreeing, test.rotation.energy, 2 * num_fitted - 3);
}

void RefuseNoisyDirection(double share, MotionEstimate* estimate) {
  if (share <= kMostNoiseInDirection) return;
  DropDirection(estimate);
  estimate->message = fmt::format(
      "the parallax is too small for the noise level: noise accounts for {:.0f} % of the information about "
      "the "
      "direction",
      100.0 * std::min(share, 1.0));
}

}  // namespace rcme
