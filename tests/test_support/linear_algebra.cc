#include "tests/test_support/linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace rcme {

Eigen::MatrixXd Multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return a * b; }

Eigen::MatrixXd Propagate(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return Multiply(Multiply(a, b), a.transpose());
}

Eigen::MatrixXd Inverse(const Eigen::MatrixXd& square) { return square.fullPivLu().inverse(); }

Eigen::MatrixXd PseudoInverse(const Eigen::MatrixXd& matrix) {
  return matrix.completeOrthogonalDecomposition().pseudoInverse();
}

Eigen::MatrixXd CholeskyFactor(const Eigen::MatrixXd& positive_definite) {
  return positive_definite.llt().matrixL();
}

bool IsPositiveDefinite(const Eigen::MatrixXd& symmetric) { return symmetric.llt().info() == Eigen::Success; }

double SquaredMahalanobis(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd solved = covariance.llt().solve(error);
  return error.dot(solved);
}

FullSvd::FullSvd(const Eigen::MatrixXd& a) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  U = svd.matrixU();
  V = svd.matrixV();
  s = svd.singularValues();
}

Eigen::VectorXd SingularValues(const Eigen::MatrixXd& matrix) { return matrix.jacobiSvd().singularValues(); }

Eigen::MatrixXd NullSpace(const Eigen::MatrixXd& a) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(a, Eigen::ComputeFullV).matrixV().rightCols(a.cols() - a.rows());
}

Eigen::VectorXd NullVector(const Eigen::MatrixXd& a) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(a, Eigen::ComputeFullV).matrixV().rightCols(1);
}

}  // namespace rcme
