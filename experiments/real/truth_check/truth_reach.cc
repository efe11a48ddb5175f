#include "experiments/real/truth_check/truth_reach.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/uncertainty/calibration_prior.h"
#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr double kReachConfidence = 0.999;
// Replaces a standard deviation that is stated as zero, rad: negligible beside any noise.
constexpr double kLeastSdRad = 1e-7;
constexpr double kWidestScale = 32.0;
constexpr int kStepsPerScale = 6;

// Takes a clipped Newton step from `pose` if it raises the likelihood; otherwise returns the pose.
RelativePose ClimbOnce(const MatchBlocks& matches, const TruthReach& reach, const RelativePose& pose,
                       const MixtureParameters& mixture, double* damping) {
  const MatchMask all = matches.All();
  const MixtureSums at = SumMixture(matches, all, pose, mixture);
  Matrix5d damped = at.hessian;
  damped.diagonal() *= 1.0 + *damping;
  const Vector5d move = -damped.llt().solve(at.gradient);
  if (!move.allFinite()) return pose;
  const RelativePose next = reach.Clip(Retract(pose, move));
  const bool is_better = SumMixture(matches, all, next, mixture).log_likelihood > at.log_likelihood;
  *damping = is_better ? std::max(0.1 * *damping, 1e-6) : std::max(10.0 * *damping, 0.1);
  return is_better ? next : pose;
}

RelativePose Climb(const MatchBlocks& matches, const TruthReach& reach, RelativePose pose,
                   MixtureParameters mixture, double widest) {
  const double scale = mixture.scale;
  for (double factor = widest; factor >= 1.0; factor *= 0.5) {
    mixture.scale = factor * scale;
    double damping = 1e-3;
    const int num_steps = factor == 1.0 ? 3 * kStepsPerScale : kStepsPerScale;
    for (int step = 0; step < num_steps; ++step) pose = ClimbOnce(matches, reach, pose, mixture, &damping);
  }
  return pose;
}

}  // namespace

TruthReach::TruthReach(const GivenTruth& truth, const FailureBounds& bounds, const Matrix5d& calibration_cov)
    : truth_(truth.cam2_from_cam1) {
  max_rotation_rad_ = kRadPerDeg * bounds.max_rotation_error_deg;
  max_direction_rad_ =
      truth.is_direction_known ? kRadPerDeg * bounds.max_direction_error_deg : std::numbers::pi;
  if (!truth.sd || !truth.is_direction_known) return;
  const Matrix5d covariance =
      truth.sd->CovarianceAt(truth_) + calibration_cov + kLeastSdRad * kLeastSdRad * Matrix5d::Identity();
  inverse_cov_ = covariance.llt().solve(Matrix5d::Identity()) / ChiSquareQuantile(5, kReachConfidence);
}

RelativePose TruthReach::Clip(const RelativePose& pose) const {
  Vector5d move = LocalCoordinates(truth_, pose);
  const double share = std::sqrt(move.dot(inverse_cov_ * move));  // of the reach
  if (share > 1.0) return Retract(truth_, move / share);
  if (!inverse_cov_.isZero(0.0)) return pose;
  const double rotation_rad = move.head<3>().norm(), direction_rad = move.tail<2>().norm();
  if (rotation_rad > max_rotation_rad_) move.head<3>() *= max_rotation_rad_ / rotation_rad;
  if (direction_rad > max_direction_rad_) move.tail<2>() *= max_direction_rad_ / direction_rad;
  return Retract(truth_, move);
}

bool IsBeyond(const FailureBounds& bounds, const GivenTruth& truth, const RelativePose& pose) {
  const RelativePose& given = truth.cam2_from_cam1;
  if (RotationAngleBetween(pose.R, given.R) > kRadPerDeg * bounds.max_rotation_error_deg) return true;
  return truth.is_direction_known &&
         AngleBetween(pose.t, given.t) > kRadPerDeg * bounds.max_direction_error_deg;
}

Matrix5d AllowedCalibrationCovariance(const MotionProblem& problem, const RelativePose& pose,
                                      const MixtureParameters& mixture) {
  const auto sums_of = [&](const MotionProblem& changed) {
    const MatchBlocks matches(changed);
    return SumMixture(matches, matches.All(), pose, mixture);
  };
  const Matrix5d inverse_hessian = sums_of(problem).hessian.llt().solve(Matrix5d::Identity());
  if (!inverse_hessian.allFinite()) return Matrix5d::Zero();
  const Matrix5d covariance = CalibrationCovariance(
      problem, {kAllowedFocalSd, kAllowedPrincipalPointSdPx, 0.0}, inverse_hessian,
      [&](const MotionProblem& changed) -> Vector5d { return sums_of(changed).gradient; });
  if (!covariance.allFinite()) return Matrix5d::Zero();
  return covariance;
}

std::vector<RelativePose> MoveTruth(const MatchBlocks& matches, const TruthReach& reach,
                                    const RelativePose& truth, const RelativePose& towards,
                                    const MixtureParameters& mixture) {
  return {truth, Climb(matches, reach, truth, mixture, 1.0),
          Climb(matches, reach, truth, mixture, kWidestScale),
          Climb(matches, reach, reach.Clip(towards), mixture, kWidestScale)};
}

}  // namespace rcme
