#include "estimator/calibrated/failure_probability.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace rcme {
namespace {

constexpr int kPairs = 64;
constexpr double kPlain = 6.0;  // standard deviations; beyond them no draw is needed

}  // namespace

bool IsWithin(const RelativePose& answer, const MotionBounds& bounds, const RelativePose& pose) {
  return RotationAngleBetween(answer.R, pose.R) <= bounds.rotation_rad &&
         AngleBetween(answer.t, pose.t) <= bounds.direction_rad;
}

double MassWithin(const RelativePose& answer, const MotionBounds& bounds, const RelativePose& mean,
                  const Matrix5d& covariance, RandomStream& rng) {
  const double rotation_away = RotationAngleBetween(answer.R, mean.R);
  const double direction_away = AngleBetween(answer.t, mean.t);
  const double rotation_reach = kPlain * std::sqrt(covariance.topLeftCorner<3, 3>().trace());
  const double direction_reach = kPlain * std::sqrt(covariance.bottomRightCorner<2, 2>().trace());
  if (rotation_away + rotation_reach < bounds.rotation_rad &&
      direction_away + direction_reach < bounds.direction_rad) {
    return 1.0;
  }
  if (rotation_away - rotation_reach > bounds.rotation_rad ||
      direction_away - direction_reach > bounds.direction_rad) {
    return 0.0;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(covariance);
  const Matrix5d root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  int num_within = 0;
  for (int pair = 0; pair < kPairs; ++pair) {
    Vector5d normal;
    for (int k = 0; k < 5; ++k) normal(k) = rng.Normal();
    const Vector5d tangent = root * normal;
    for (const double sign : {1.0, -1.0})
      num_within += IsWithin(answer, bounds, Retract(mean, sign * tangent));
  }
  return num_within / (2.0 * kPairs);
}

}  // namespace rcme
