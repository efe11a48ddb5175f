#include "estimator/solvers/eight_point.h"

#include <Eigen/QR>
#include <cmath>

namespace rcme {

// f of eight matches (eq::model_instantiate), and the gain G of its covariance G D G' (eq. 6).
std::optional<LinearModel> EightPoint::Solve(const Rays& rays1, const Rays& rays2) {
  using Matrix8d = Eigen::Matrix<double, 8, 8>;
  Eigen::Matrix<double, 9, 8> M_transposed;
  for (int k = 0; k < kSampleSize; ++k) {
    const size_t i = static_cast<size_t>(k);
    for (int row = 0; row < 3; ++row) M_transposed.block<3, 1>(3 * row, k) = rays2[i](row) * rays1[i];
  }

  // M' P = Q R: the last column of Q is normal to every row of M, the first eight are A, and M A = P R1' with
  // the 8x8 triangle R1. A single Householder QR therefore gives the null vector, its complement and the
  // gain.
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 9, 8>> qr(M_transposed);
  const Matrix8d R1 = qr.matrixQR().topRows<8>().triangularView<Eigen::Upper>();
  const double smallest_pivot = std::abs(R1(7, 7));
  if (!(smallest_pivot > 1e-9 * std::abs(R1(0, 0)))) return std::nullopt;

  const Matrix9d Q = qr.householderQ();
  LinearModel model;
  model.f = Q.col(8);
  model.A = Q.leftCols<8>();
  const Matrix8d MA_inverse =
      R1.transpose().triangularView<Eigen::Lower>().solve(Matrix8d(qr.colsPermutation().transpose()));
  model.G = model.A * MA_inverse;
  return model;
}

ModelList<LinearModel, EightPoint::kMaxModels> EightPoint::FindModels(const Rays& rays1, const Rays& rays2) {
  ModelList<LinearModel, kMaxModels> models;
  if (const std::optional<LinearModel> model = Solve(rays1, rays2)) models.Add(*model);
  return models;
}

}  // namespace rcme
