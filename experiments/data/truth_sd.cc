#include "experiments/data/truth_sd.h"

#include <cmath>

#include "stats/constants.h"

namespace rcme {

Matrix5d TruthSd::CovarianceAt(const RelativePose& pose) const {
  Matrix5d covariance = Matrix5d::Zero();
  covariance.topLeftCorner<3, 3>() = rotation_rad.cwiseAbs2().asDiagonal();
  const Eigen::Matrix<double, 3, 2> B = DirectionBasis(pose.t);
  covariance.bottomRightCorner<2, 2>() = B.transpose() * translation.cwiseAbs2().asDiagonal() * B;
  return covariance;
}

bool PoseSd::IsDirectionWeak(double baseline) const { return baseline <= 3.0 * std::sqrt(2.0) * position; }

TruthSd SdOfMotion(const PoseSd& pose, double baseline) {
  const double rotation_rad = kRadPerDeg * pose.rotation_deg;
  const double translation = std::hypot(std::sqrt(2.0) * pose.position / baseline, rotation_rad);
  return {Eigen::Vector3d::Constant(std::sqrt(2.0) * rotation_rad), Eigen::Vector3d::Constant(translation)};
}

}  // namespace rcme
