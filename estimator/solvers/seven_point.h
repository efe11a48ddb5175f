#pragma once

#include "estimator/solvers/minimal_solver.h"

namespace rcme {

// All fundamental matrices of rank 2 through seven correspondences (Hartley & Zisserman, 11.1.2), on
// calibrated rays: seven equations for the seven degrees of freedom of F, the exact case. The null space of M
// (7x9, rows kron(x2, x1)) holds F = z F_1 + F_2, and the cubic det F = 0 leaves one or three real z.
//
// F is exact, its motion is not: the step from F to the nearest essential matrix (ProjectToEssential, in
// rays) leaves the two directions of F that no motion has.
//
// Rays K^-1 x are the normalisation, as for eight points: neither the null space nor the cubic's roots change
// in Hartley's coordinates.
class SevenPoint {
 public:
  static constexpr int kSampleSize = 7;
  static constexpr int kMaxModels = 3;
  static constexpr SolverCase kCase = SolverCase::kExact;  // of F
  static constexpr int kSampleTestDof = 2;                 // 7 equations, the motion has 5
  using Rays = std::array<Eigen::Vector3d, kSampleSize>;
  using Model = MinimalModel<kSampleSize>;

  // G is T (M T)^-1, T (9x7) the tangent at f of the unit vectors with det F = 0: the complement of f and of
  // the gradient of det, the cofactors of F.
  //
  // None if the points do not determine finitely many F (smallest pivot of M below 1e-9 of the largest, or
  // the cubic vanishes), and none that is a double root.
  static ModelList<Model, kMaxModels> FindModels(const Rays& rays1, const Rays& rays2);
};

}  // namespace rcme
