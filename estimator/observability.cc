#include "estimator/observability.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimator/match_whitening.h"
#include "estimator/motion_chance.h"
#include "estimator/refinement/fit_set.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// log NFA of a rotation that has `num_within` matches within c.
double LogFalseAlarmsOfRotation(const MotionProblem& problem, double significance_level, int num_within) {
  const int n = static_cast<int>(problem.matches.size());
  const double chance = ChanceOfAgreementWithRotation(problem, TailThreshold(n, significance_level));
  return LogFalseAlarms(kRotations, n, num_within, chance);
}

// The greatest log NFA of a rotation that explains the matches. `chance` is that of the motion.
double MostLogFalseAlarms(int num_matches, int num_agreeing, double chance, double significance_level) {
  return std::min(std::log(significance_level / 3.0),
                  LogFalseAlarms(kMotions, num_matches, num_agreeing, chance));
}

bool HasExcessEnergy(const RotationFit& rotation, double significance_level) {
  return rotation.num_fitted >= 3 &&
         ChiSquareCdf(2 * rotation.num_fitted - 3, rotation.energy) > 1.0 - significance_level;
}

}  // namespace

double AgreementThreshold() { return ChiSquareQuantile(1, 1.0 - kFitSignificance); }

double TailThreshold(int num_matches, double significance_level) {
  return -2.0 * std::log(significance_level / 3.0 / num_matches);
}

void DecideRotationTest(const MotionProblem& problem, double chance, double significance_level,
                        RotationTest* test) {
  const int n = static_cast<int>(problem.matches.size());
  const double third = significance_level / 3.0;
  const RotationFit& rotation = test->rotation;
  test->num_beyond = test->num_agreeing - rotation.num_fitted;
  test->num_unexplained = n - rotation.num_within;
  if (HasExcessEnergy(rotation, third)) return;
  if (LogFalseAlarmsOfRotation(problem, significance_level, rotation.num_within) >
      MostLogFalseAlarms(n, test->num_agreeing, chance, significance_level))
    return;
  const ModelFamily& family = rotation.num_fitted >= 10 ? kDirections : kMotions;
  test->explains_matches =
      LogFalseAlarms(family, test->num_unexplained, test->num_beyond, chance) > std::log(third);
}

bool MayRotationExplain(const MotionProblem& problem, double chance, double significance_level,
                        int num_agreeing, int most_within) {
  const int n = static_cast<int>(problem.matches.size());
  // If a tail is too small for a double, LogFalseAlarms uses Chernoff's bound, which exceeds the log tail by
  // at most log(2 n) / 2 (Ash 1965, lemma 4.7.2). A smaller number of matches may therefore get an NFA
  // smaller by that much.
  const double least =
      LogFalseAlarmsOfRotation(problem, significance_level, most_within) - 0.5 * std::log(2.0 * n);
  return least <= MostLogFalseAlarms(n, num_agreeing, chance, significance_level);
}

Eigen::Matrix2d SumDirectionNoise(const MotionProblem& problem, const std::vector<int>& fitted,
                                  const RelativePose& pose, const Eigen::Matrix2d& direction_cov) {
  const MatchWhitening whitening(problem);
  const RayScale& s = whitening.ray_scale();
  Eigen::Matrix3d axes, axes_in_cam1;  // t, B, column by column
  axes << pose.t, DirectionBasis(pose.t);
  axes_in_cam1 = pose.R.transpose() * axes;
  const double most = MaxLeverage(static_cast<int>(fitted.size()));
  Eigen::Matrix2d noise = Eigen::Matrix2d::Zero();
  for (const int i : fitted) {
    const Correspondence& match = problem.matches[static_cast<size_t>(i)];
    const Eigen::Vector2d x1 = whitening.WhitenPoint1(match.x1_px), x2 = whitening.WhitenPoint2(match.x2_px);
    const Eigen::Vector3d ray1(s.x1 * x1.x(), s.y1 * x1.y(), 1.0);
    const Eigen::Vector3d ray2(s.x2 * x2.x(), s.y2 * x2.y(), 1.0);
    const Eigen::Vector3d y = pose.R * ray1, ray2_in_cam1 = pose.R.transpose() * ray2;
    Eigen::Matrix<double, 3, 4> J;  // d(axes' m) / d(x2, y2, x1, y1) in units of sigma: v'(y x d) = (v x y)'d
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d moment2 = axes.col(k).cross(y), moment1 = ray2_in_cam1.cross(axes_in_cam1.col(k));
      J.row(k) << s.x2 * moment2.x(), s.y2 * moment2.y(), s.x1 * moment1.x(), s.y1 * moment1.y();
    }
    const double variance = J.row(0).squaredNorm();
    const Eigen::Matrix2d own = J.bottomRows<2>() * J.bottomRows<2>().transpose();
    if ((direction_cov * own).trace() <= most * variance) noise += own / variance;
  }
  return noise;
}

double NoiseShareOfDirection(const Eigen::Matrix2d& direction_cov, const Eigen::Matrix2d& noise) {
  // The eigenvalues of a product of two positive definite matrices are real.
  const Eigen::Matrix2d share = direction_cov * noise;
  const double half_trace = 0.5 * share.trace();
  return half_trace + std::sqrt(std::max(half_trace * half_trace - share.determinant(), 0.0));
}

}  // namespace rcme
