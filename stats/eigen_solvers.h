#pragma once

#include <Eigen/Dense>

// Eigen's solvers of sizes used by many sources are compiled once, in eigen_solvers.cc: each source that
// needs the eigenvalues of a 5x5 matrix compiles eight seconds faster. Rooms and tests have this header among
// their precompiled ones, so no source includes it. Without it a source compiles its own copy and computes
// the same.
//
// The list has the solvers that several sources use, or one source whose room is compiled with costly
// optimisation. A solver that only one test or one source of the experiments uses is compiled there, so that
// builds without it save the time.
//
// A decomposition of an expression is still compiled in place: write
// SelfAdjointEigenSolver<Matrix5d>(Matrix5d(A * B)), not (A * B).
//
// WHERE: `extern` declares the instantiations, an empty argument compiles them.
#define RCME_EIGENVALUES(WHERE, MATRIX)                                                   \
  WHERE template SelfAdjointEigenSolver<MATRIX>& SelfAdjointEigenSolver<MATRIX>::compute( \
      const EigenBase<MATRIX>&, int);

#define RCME_TRIANGLE(WHERE, TRIANGLE, MODE, RIGHT)                                             \
  WHERE template void TriangularViewImpl<const TRIANGLE, MODE, Dense>::solveInPlace<OnTheLeft>( \
      const MatrixBase<RIGHT>&) const;

#define RCME_CHOLESKY(WHERE, MATRIX, VECTOR)                                    \
  WHERE template LLT<MATRIX>& LLT<MATRIX>::compute(const EigenBase<MATRIX>&);   \
  WHERE template LDLT<MATRIX>& LDLT<MATRIX>::compute(const EigenBase<MATRIX>&); \
  WHERE template void LDLT<MATRIX>::_solve_impl(const VECTOR&, VECTOR&) const;  \
  RCME_TRIANGLE(WHERE, MATRIX, Lower, VECTOR)                                   \
  RCME_TRIANGLE(WHERE, MATRIX, Lower, MATRIX)                                   \
  RCME_TRIANGLE(WHERE, Transpose<const MATRIX>, Upper, MATRIX)

namespace Eigen {
namespace rcme_sizes {
using M5 = Matrix<double, 5, 5>;
using V5 = Matrix<double, 5, 1>;
}  // namespace rcme_sizes
#define RCME_SOLVERS_OF_MANY(WHERE)                                                                   \
  RCME_EIGENVALUES(WHERE, rcme_sizes::M5)                                                             \
  RCME_CHOLESKY(WHERE, rcme_sizes::M5, rcme_sizes::V5)                                                \
  WHERE template void LLT<rcme_sizes::M5>::_solve_impl(const rcme_sizes::V5&, rcme_sizes::V5&) const; \
  WHERE template void LLT<rcme_sizes::M5>::_solve_impl(const rcme_sizes::M5&, rcme_sizes::M5&) const; \
  RCME_TRIANGLE(WHERE, Transpose<const rcme_sizes::M5>, Upper, rcme_sizes::V5)                        \
  WHERE template void PartialPivLU<rcme_sizes::M5>::compute();                                        \
  RCME_TRIANGLE(WHERE, rcme_sizes::M5, UnitLower, rcme_sizes::M5)                                     \
  RCME_TRIANGLE(WHERE, rcme_sizes::M5, Upper, rcme_sizes::M5)

#define RCME_SOLVERS_OF_OTHER_SIZES(WHERE)                                           \
  RCME_EIGENVALUES(WHERE, Matrix2d)                                                  \
  RCME_EIGENVALUES(WHERE, Matrix3d)                                                  \
  RCME_EIGENVALUES(WHERE, Matrix4d)                                                  \
  RCME_EIGENVALUES(WHERE, MatrixXd)                                                  \
  RCME_CHOLESKY(WHERE, MatrixXd, VectorXd)                                           \
  WHERE template void LDLT<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const; \
  WHERE template void ColPivHouseholderQR<MatrixXd>::computeInPlace();

RCME_SOLVERS_OF_MANY(extern)
RCME_SOLVERS_OF_OTHER_SIZES(extern)
}  // namespace Eigen
