#include "estimator/solvers/linear_fit.h"

#include <Eigen/SVD>

namespace rcme {

Vector8d LinearFit::LocalCoordinates(const Vector9d& other) const {
  const Vector8d coordinates = A.transpose() * other;
  return f.dot(other) < 0.0 ? Vector8d(-coordinates) : coordinates;
}

std::optional<LinearFit> FitLinear(std::span<const Eigen::Vector3d> rays1,
                                   std::span<const Eigen::Vector3d> rays2) {
  Eigen::MatrixXd M(rays1.size(), 9);
  for (size_t k = 0; k < rays1.size(); ++k) {
    M.row(static_cast<Eigen::Index>(k)) = Vectorize(rays2[k] * rays1[k].transpose());
  }
  if (M.rows() < 8 || !M.allFinite()) return std::nullopt;

  // M = U S V': f is the last column of V, A the first eight, and M A = U_8 S_8.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(M, Eigen::ComputeThinU | Eigen::ComputeFullV);
  const Vector8d s = svd.singularValues().head<8>();
  if (!(s(7) > 1e-9 * s(0))) return std::nullopt;
  LinearFit fit;
  fit.f = svd.matrixV().col(8);
  fit.A = svd.matrixV().leftCols<8>();
  fit.G = fit.A * s.cwiseInverse().asDiagonal() * svd.matrixU().leftCols<8>().transpose();
  fit.conditioning = s(7) / s(0);
  return fit;
}

}  // namespace rcme
