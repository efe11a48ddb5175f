#pragma once

#include <Eigen/Dense>

// Eigen's solvers of the sizes that many sources use are compiled once, in eigen_solvers.cc: a source that
// asks for the eigenvalues of a 5x5 matrix takes the compiler eight seconds less. The rooms and tests have
// this header among their precompiled ones, so that no source includes it; without it a source compiles its
// own and computes the same.
//
// A decomposition of an expression is still compiled where it stands:
// SelfAdjointEigenSolver<Matrix5d>(Matrix5d(A * B)), not (A * B).
//
// WHERE: `extern` declares them, nothing compiles them.
#define RCME_EIGENVALUES(WHERE, MATRIX)                                                   \
  WHERE template SelfAdjointEigenSolver<MATRIX>& SelfAdjointEigenSolver<MATRIX>::compute( \
      const EigenBase<MATRIX>&, int);

#define RCME_TRIANGLE(WHERE, TRIANGLE, MODE, RIGHT)                                             \
  WHERE template void TriangularViewImpl<const TRIANGLE, MODE, Dense>::solveInPlace<OnTheLeft>( \
      const MatrixBase<RIGHT>&) const;

#define RCME_LINEAR_SOLVERS(WHERE, MATRIX, VECTOR)                              \
  WHERE template LLT<MATRIX>& LLT<MATRIX>::compute(const EigenBase<MATRIX>&);   \
  WHERE template LDLT<MATRIX>& LDLT<MATRIX>::compute(const EigenBase<MATRIX>&); \
  WHERE template void LLT<MATRIX>::_solve_impl(const VECTOR&, VECTOR&) const;   \
  WHERE template void LLT<MATRIX>::_solve_impl(const MATRIX&, MATRIX&) const;   \
  WHERE template void LDLT<MATRIX>::_solve_impl(const VECTOR&, VECTOR&) const;  \
  WHERE template void LDLT<MATRIX>::_solve_impl(const MATRIX&, MATRIX&) const;  \
  WHERE template void PartialPivLU<MATRIX>::compute();                          \
  RCME_TRIANGLE(WHERE, MATRIX, Lower, VECTOR)                                   \
  RCME_TRIANGLE(WHERE, MATRIX, Lower, MATRIX)                                   \
  RCME_TRIANGLE(WHERE, MATRIX, UnitLower, MATRIX)                               \
  RCME_TRIANGLE(WHERE, MATRIX, Upper, MATRIX)                                   \
  RCME_TRIANGLE(WHERE, Transpose<const MATRIX>, Upper, VECTOR)                  \
  RCME_TRIANGLE(WHERE, Transpose<const MATRIX>, Upper, MATRIX)

namespace Eigen {
namespace rcme_sizes {
using M5 = Matrix<double, 5, 5>;
using V5 = Matrix<double, 5, 1>;
using M7 = Matrix<double, 7, 7>;
using M9 = Matrix<double, 9, 9>;
}  // namespace rcme_sizes
#define RCME_SOLVERS_OF_MANY(WHERE)       \
  RCME_EIGENVALUES(WHERE, rcme_sizes::M5) \
  RCME_EIGENVALUES(WHERE, rcme_sizes::M7) \
  RCME_EIGENVALUES(WHERE, rcme_sizes::M9) \
  RCME_LINEAR_SOLVERS(WHERE, rcme_sizes::M5, rcme_sizes::V5)

#define RCME_SOLVERS_OF_OTHER_SIZES(WHERE)                             \
  RCME_EIGENVALUES(WHERE, Matrix2d)                                    \
  RCME_EIGENVALUES(WHERE, Matrix3d)                                    \
  RCME_EIGENVALUES(WHERE, Matrix4d)                                    \
  RCME_EIGENVALUES(WHERE, MatrixXd)                                    \
  RCME_LINEAR_SOLVERS(WHERE, MatrixXd, VectorXd)                       \
  WHERE template void ColPivHouseholderQR<MatrixXd>::computeInPlace(); \
  WHERE template void ColPivHouseholderQR<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;

RCME_SOLVERS_OF_MANY(extern)
RCME_SOLVERS_OF_OTHER_SIZES(extern)
}  // namespace Eigen
