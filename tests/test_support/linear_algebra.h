// Linear algebra for tests, compiled once for every size: the compiler needs seconds for each expression of
// Eigen's of a size that no other source has. Arguments of fixed size convert.
#pragma once

#include <Eigen/Core>

namespace rcme {

Eigen::MatrixXd Multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

// a b a', n x n of a (n x m) and b (m x m).
Eigen::MatrixXd Propagate(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

// By LU with full pivoting.
Eigen::MatrixXd Inverse(const Eigen::MatrixXd& square);

// By a complete orthogonal decomposition.
Eigen::MatrixXd PseudoInverse(const Eigen::MatrixXd& matrix);

// L of L L' = a.
Eigen::MatrixXd CholeskyFactor(const Eigen::MatrixXd& positive_definite);

bool IsPositiveDefinite(const Eigen::MatrixXd& symmetric);

// e' C^-1 e of an error e and its covariance C.
double SquaredMahalanobis(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance);

// Descending.
Eigen::VectorXd SingularValues(const Eigen::MatrixXd& matrix);

// a = U diag(s) V', U and V square.
struct FullSvd {
  explicit FullSvd(const Eigen::MatrixXd& a);
  Eigen::MatrixXd U, V;
  Eigen::VectorXd s;  // descending
};

// The unit vector x of the least |a x|.
Eigen::VectorXd NullVector(const Eigen::MatrixXd& a);
// Orthonormal columns: those of a (m x n), m < n, of rank m.
Eigen::MatrixXd NullSpace(const Eigen::MatrixXd& a);

}  // namespace rcme
