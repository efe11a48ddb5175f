#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "estimator/solvers/minimal_solver.h"

namespace rcme {

// All essential matrices through five correspondences of calibrated rays. It is the exact case: five
// equations for the five degrees of freedom of the motion, with up to ten real solutions (Nister 2004; the
// action matrix of Stewenius, Engels & Nister 2006).
//
// The four-dimensional null space of M (5x9, rows kron(x2, x1)) contains E = x E_1 + y E_2 + z E_3 + w E_4.
// The ten cubics det E = 0 and 2 E E' E - tr(E E') E = 0 leave finitely many (x : y : z : w). Newton's method
// on the five epipolar equations over the motions polishes each solution, so that E is an essential matrix
// despite rounding in the elimination.
class FivePoint {
 public:
  static constexpr int kSampleSize = 5;
  static constexpr int kMaxModels = 10;
  static constexpr SolverCase kCase = SolverCase::kExact;
  static constexpr int kSampleTestDof = 0;  // the motion fits its sample exactly
  using Rays = std::array<Eigen::Vector3d, kSampleSize>;
  using Model = MinimalModel<kSampleSize>;

  // f = vec(E) / sqrt(2). Along the motions delta f = T delta p, T = dE/dp / sqrt(2), so G = T (C T)^-1 and
  // Sigma_p = H^-1 D H^-T with H = C T = dg/dp (C: ConstraintRows).
  static ModelList<Model, kMaxModels> FindModels(const Rays& rays1, const Rays& rays2);

  // The model nearest to `E`, by Newton's method: the one that FindModels returns for a solution `E` of
  // another implementation. nullopt if the iteration does not settle or the solution is not isolated.
  static std::optional<Model> ModelNear(const Eigen::Matrix3d& E, const Rays& rays1, const Rays& rays2);

  // E[0] ... E[count - 1] with x2' E x1 = 0 in rays and Frobenius norm sqrt(2), that of [t]x R with |t| = 1;
  // the sign is arbitrary. Sorted by descending |E_33|, so that another implementation which finds the same
  // solutions numbers them alike (kernels/block_source.h).
  struct Solutions {
    std::array<Eigen::Matrix3d, kMaxModels> E;
    int count = 0;
  };

  // Only isolated solutions: none if fewer than five points differ or one is not finite, and none from a
  // family such as that of a pure rotation (the smallest pivot of M, or of the 5x5 Jacobian of the equations
  // at the solution, is below 1e-9 of the largest). Allocates nothing.
  static Solutions Solve(const Rays& rays1, const Rays& rays2);
};

}  // namespace rcme
