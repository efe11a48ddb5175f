#include "experiments/data/truth_sd.h"

namespace rcme {

Matrix5d TruthSd::CovarianceAt(const RelativePose& pose) const {
  Matrix5d covariance = Matrix5d::Zero();
  covariance.topLeftCorner<3, 3>() = rotation_rad.cwiseAbs2().asDiagonal();
  const Eigen::Matrix<double, 3, 2> B = DirectionBasis(pose.t);
  covariance.bottomRightCorner<2, 2>() = B.transpose() * translation.cwiseAbs2().asDiagonal() * B;
  return covariance;
}

}  // namespace rcme
