#include "estimator/observability.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/kernels/score.h"
#include "estimator/motion_chance.h"
#include "estimator/refinement/fit_set.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

bool HasExcessEnergy(const RotationFit& rotation, double significance_level) {
  const int num_fitted = CountIn(rotation.fitted);
  return num_fitted >= 3 && ChiSquareCdf(2 * num_fitted - 3, rotation.energy) > 1.0 - significance_level;
}

double ThresholdOfTail(const MatchBlocks& matches, double significance_level) {
  return -2.0 * std::log(significance_level / matches.num_matches());
}

}  // namespace

RotationTest TestRotationAlone(const MotionProblem& problem, const MatchBlocks& matches,
                               const RelativePose& pose, double significance_level) {
  const double threshold = ChiSquareQuantile(1, 1.0 - kFitSignificance), third = significance_level / 3.0;
  double F[9];
  WriteRowMajor(matches.FundamentalFromEssential(EssentialFromPose(pose)), F);
  InlierScan scan(matches);
  ScanKnownPose(matches, F, threshold, &scan);

  RotationTest test;
  const double tail = ThresholdOfTail(matches, third);
  test.rotation = FitRotation(matches, scan.inliers, pose.R, tail);
  test.num_agreeing = scan.num_inliers;
  test.num_beyond = test.num_agreeing - CountIn(test.rotation.fitted);
  const int n = matches.num_matches(), num_within = CountIn(test.rotation.within);
  test.num_unexplained = n - num_within;
  if (HasExcessEnergy(test.rotation, third)) return test;
  const double chance = ChanceOfAgreement(problem, matches, pose, threshold);
  const double of_rotation =
      LogFalseAlarms(kRotations, n, num_within, ChanceOfAgreementWithRotation(problem, matches, tail));
  const double of_motion = LogFalseAlarms(kMotions, n, test.num_agreeing, chance);
  if (of_rotation > std::min(std::log(third), of_motion)) return test;
  const ModelFamily& family = CountIn(test.rotation.fitted) >= 10 ? kDirections : kMotions;
  test.explains_matches =
      LogFalseAlarms(family, test.num_unexplained, test.num_beyond, chance) > std::log(third);
  return test;
}

RotationTest TestRotationAloneFrom(const MotionProblem& problem, const MatchBlocks& matches,
                                   const RelativePose& start, const MatchMask& support,
                                   double significance_level) {
  const RotationFit fit =
      FitRotation(matches, support, start.R, ThresholdOfTail(matches, significance_level / 3.0));
  return TestRotationAlone(problem, matches, {fit.R, start.t}, significance_level);
}

double NoiseShareOfDirection(const MatchBlocks& matches, const std::vector<int>& fitted,
                             const RelativePose& pose, const Eigen::Matrix2d& direction_cov) {
  const RayScale& s = matches.ray_scale();
  Eigen::Matrix3d axes, axes_in_cam1;  // t, B, column by column
  axes << pose.t, DirectionBasis(pose.t);
  axes_in_cam1 = pose.R.transpose() * axes;
  const double most = MaxLeverage(static_cast<int>(fitted.size()));
  Eigen::Matrix2d noise = Eigen::Matrix2d::Zero();
  for (const int i : fitted) {
    const MatchBlock& block = matches[i / kBlockSize];
    const int lane = i % kBlockSize;
    const Eigen::Vector3d ray1(s.x1 * block.x1[lane], s.y1 * block.y1[lane], 1.0);
    const Eigen::Vector3d ray2(s.x2 * block.x2[lane], s.y2 * block.y2[lane], 1.0);
    const Eigen::Vector3d y = pose.R * ray1, ray2_in_cam1 = pose.R.transpose() * ray2;
    Eigen::Matrix<double, 3, 4> J;  // d(axes' m) / d(x2, y2, x1, y1) in units of sigma: v'(y x d) = (v x y)'d
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d of_2 = axes.col(k).cross(y), of_1 = ray2_in_cam1.cross(axes_in_cam1.col(k));
      J.row(k) << s.x2 * of_2.x(), s.y2 * of_2.y(), s.x1 * of_1.x(), s.y1 * of_1.y();
    }
    const double variance = J.row(0).squaredNorm();
    const Eigen::Matrix2d own = J.bottomRows<2>() * J.bottomRows<2>().transpose();
    if ((direction_cov * own).trace() <= most * variance) noise += own / variance;
  }
  const Eigen::Matrix2d share = direction_cov * noise;  // its eigenvalues are real, as those of a product of
                                                        // two positive definite matrices are
  const double half_trace = 0.5 * share.trace();
  return half_trace + std::sqrt(std::max(half_trace * half_trace - share.determinant(), 0.0));
}

}  // namespace rcme
