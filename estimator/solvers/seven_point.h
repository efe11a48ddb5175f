#pragma once

#include "estimator/solvers/minimal_solver.h"

namespace rcme {

// All fundamental matrices of rank 2 through seven correspondences (Hartley & Zisserman, 11.1.2), on
// calibrated rays. It is the exact case for F: seven equations for its seven degrees of freedom. The null
// space of M (7x9, rows kron(x2, x1)) contains F = z F_1 + F_2, and the cubic det F = 0 has one or three real
// roots z.
//
// F fits the sample exactly, its motion does not: the step from F to the nearest essential matrix
// (ProjectToEssential, in rays) removes two degrees of freedom that no motion has.
//
// Rays K^-1 x are the only normalisation, as for eight points: Hartley's coordinates change neither the null
// space nor the roots of the cubic.
class SevenPoint {
 public:
  static constexpr int kSampleSize = 7;
  static constexpr int kMaxModels = 3;
  static constexpr SolverCase kCase = SolverCase::kExact;  // of F
  static constexpr int kSampleTestDof = 2;                 // 7 equations, 5 degrees of freedom
  using Rays = std::array<Eigen::Vector3d, kSampleSize>;
  using Model = MinimalModel<kSampleSize>;

  // G is T (M T)^-1, T (9x7) the tangent at f of the unit vectors with det F = 0: the complement of f and of
  // the gradient of det, which is the cofactor matrix of F.
  //
  // No model if the points do not determine finitely many F (the smallest pivot of M is below 1e-9 of the
  // largest, or the cubic vanishes). Double roots are left out.
  static ModelList<Model, kMaxModels> FindModels(const Rays& rays1, const Rays& rays2);
};

}  // namespace rcme
