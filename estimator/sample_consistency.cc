#include "estimator/sample_consistency.h"

#include <Eigen/Cholesky>
#include <limits>

namespace rcme {

double JointSampleStatistic(const Hypothesis& hypothesis) {
  // At E = U diag(1, 1, 0) V' the motions and the scale move U [e12 - e21, e31, e32, e13, e23, e11 + e22] V'.
  // The complement in R^9 is U [e11 - e22, e12 + e21, e33] V'.
  const Eigen::Matrix3d& U = hypothesis.projection.U;
  const Eigen::Matrix3d& V = hypothesis.projection.V;
  Eigen::Matrix<double, 9, 3> N;
  const double unit = 1.0 / std::sqrt(2.0);
  N.col(0) = unit * Vectorize(U.col(0) * V.col(0).transpose() - U.col(1) * V.col(1).transpose());
  N.col(1) = unit * Vectorize(U.col(0) * V.col(1).transpose() + U.col(1) * V.col(0).transpose());
  N.col(2) = Vectorize(U.col(2) * V.col(2).transpose());
  const Eigen::Vector3d misfit = N.transpose() * hypothesis.linear.f;
  const Eigen::Matrix3d misfit_cov = N.transpose() * hypothesis.f_cov * N;
  const Eigen::LLT<Eigen::Matrix3d> llt(misfit_cov);
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return misfit.dot(llt.solve(misfit));
}

}  // namespace rcme
