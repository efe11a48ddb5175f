#include "estimator/sample_consistency.h"

#include <Eigen/Cholesky>
#include <limits>

namespace rcme {

// The statistic of the joint test of a sample (eq::sample-p-test).
template <int dof>
double MisfitStatistic(const EssentialProjection& projection, const Vector9d& f, const Matrix9d& f_cov) {
  // The motions and the scale move U [e12 - e21, e31, e32, e13, e23, e11 + e22] V'.
  const Eigen::Matrix3d& U = projection.U;
  const Eigen::Matrix3d& V = projection.V;
  Eigen::Matrix<double, 9, dof> N;
  const double unit = 1.0 / std::sqrt(2.0);
  N.col(0) = unit * Vectorize(U.col(0) * V.col(0).transpose() - U.col(1) * V.col(1).transpose());
  N.col(1) = unit * Vectorize(U.col(0) * V.col(1).transpose() + U.col(1) * V.col(0).transpose());
  if constexpr (dof == 3) N.col(2) = Vectorize(U.col(2) * V.col(2).transpose());
  using Vector = Eigen::Matrix<double, dof, 1>;
  using Matrix = Eigen::Matrix<double, dof, dof>;
  const Vector misfit = N.transpose() * f;
  const Matrix misfit_cov = N.transpose() * f_cov * N;
  const Eigen::LLT<Matrix> llt(misfit_cov);
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return misfit.dot(llt.solve(misfit));
}

template double MisfitStatistic<2>(const EssentialProjection&, const Vector9d&, const Matrix9d&);
template double MisfitStatistic<3>(const EssentialProjection&, const Vector9d&, const Matrix9d&);

}  // namespace rcme
