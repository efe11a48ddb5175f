#include "estimator/uncertainty/as_printed.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "estimator/geometry/sampson.h"

namespace rcme {

Matrix9d SampleInformation(const Vector9d& f, const Camera& camera1, const Camera& camera2,
                           std::span<const Correspondence> matches, double sigma_px) {
  const Eigen::Matrix3d F = FundamentalFromEssential(Matricize(f), camera1, camera2);
  Matrix9d information = Matrix9d::Zero();
  for (const Correspondence& match : matches) {
    const Eigen::Vector4d gradient = EvaluateConstraint(F, match).gradient;
    const Vector9d d_g_d_f =
        Vectorize(camera2.Ray(match.x2_px) * camera1.Ray(match.x1_px).transpose());  // kron(x2, x1)
    const Eigen::Matrix<double, 4, 9> J_Omega = -gradient / gradient.squaredNorm() * d_g_d_f.transpose();
    information += J_Omega.transpose() * J_Omega / (sigma_px * sigma_px);
  }
  return information;
}

// Sigma_f as printed (eq. 6).
Matrix9d OverdeterminedCovariance(const Matrix9d& information, const Eigen::Matrix<double, 9, 8>& A) {
  const Eigen::Matrix<double, 8, 8> reduced = A.transpose() * information * A;
  return A * reduced.fullPivLu().inverse() * A.transpose();
}

Eigen::Matrix<double, 9, 8> HouseholderColumns(const Vector9d& f, int onto) {
  Vector9d v = f;
  v(onto) += f(onto) < 0.0 ? -1.0 : 1.0;
  const Matrix9d reflection = Matrix9d::Identity() - (2.0 / v.squaredNorm()) * v * v.transpose();
  return reflection.leftCols<8>();
}

// The statistic (eq::mahalanobis_dist_F) with the pseudo-inverse in the place of the inverse.
double RankOneDistance(const Eigen::Vector4d& delta, const Eigen::Matrix4d& delta_cov) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(delta_cov);
  const double along = eigen.eigenvectors().col(3).dot(delta);
  return along * along / eigen.eigenvalues()(3);
}

}  // namespace rcme
