#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "estimator/solvers/minimal_solver.h"

namespace rcme {

// The unit null vector f of M f = 0 (M 8x9, rows kron(x2, x1) in rays) and its sensitivity to noise in the
// eight constraints. If g_k = x2_k' F x1_k is disturbed by n_k, then delta f = -G n to first order, G = A (M
// A)^-1 (9x8), A' f = 0.
struct LinearModel {
  Vector9d f = Vector9d::Zero();
  Eigen::Matrix<double, 9, 8> A = Eigen::Matrix<double, 9, 8>::Zero();
  Eigen::Matrix<double, 9, 8> G = Eigen::Matrix<double, 9, 8>::Zero();
};

// The 8-point algorithm on calibrated rays (Longuet-Higgins 1981; Hartley & Zisserman, algorithm 11.1).
//
// The only normalisation is by rays K^-1 x. With exactly eight points Hartley's coordinates have the same
// null vector, and the projection to rank 2 acts on E (ProjectToEssential), not here.
class EightPoint {
 public:
  static constexpr int kSampleSize = 8;
  static constexpr int kMaxModels = 1;
  static constexpr SolverCase kCase = SolverCase::kOverdetermined;  // 8 parameters, F has 7 dof
  static constexpr int kSampleTestDof = 3;                          // 8 equations, 5 degrees of freedom
  using Rays = std::array<Eigen::Vector3d, kSampleSize>;
  using Model = LinearModel;
  static ModelList<Model, kMaxModels> FindModels(const Rays& rays1, const Rays& rays2);

  // nullopt if the eight points do not determine f (coplanar points, repeated points, pure rotation, ...):
  // the smallest pivot is below 1e-9 of the largest.
  static std::optional<LinearModel> Solve(const Rays& rays1, const Rays& rays2);
};

}  // namespace rcme
