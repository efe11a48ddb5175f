#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "estimator/solvers/minimal_solver.h"

namespace rcme {

// All essential matrices through five correspondences of calibrated rays, the exact case: five equations for
// the five degrees of freedom of the motion, and up to ten real solutions (Nister 2004; the action matrix of
// Stewenius, Engels & Nister 2006).
//
// The four-dimensional null space of M (5x9, rows kron(x2, x1)) holds E = x E_1 + y E_2 + z E_3 + w E_4; the
// ten cubics det E = 0 and 2 E E' E - tr(E E') E = 0 leave finitely many (x : y : z : w). Every one is then
// polished by Newton's method on the five epipolar equations over the motions, so that E is an essential
// matrix whatever the rounding of the elimination.
class FivePoint {
 public:
  static constexpr int kSampleSize = 5;
  static constexpr int kMaxModels = 10;
  static constexpr SolverCase kCase = SolverCase::kExact;
  static constexpr int kSampleTestDof = 0;  // the motion fits its sample: nothing is left to test
  using Rays = std::array<Eigen::Vector3d, kSampleSize>;
  using Model = MinimalModel<kSampleSize>;

  // f = vec(E) / sqrt(2). Along the motions delta f = T delta p, T = dE/dp / sqrt(2), so that G is T (C T)^-1
  // and Sigma_p = H^-1 D H^-T with H = C T = dg/dp.
  static ModelList<Model, kMaxModels> FindModels(const Rays& rays1, const Rays& rays2);

  // The model next to `E`, by Newton's method: what FindModels has if another implementation found `E`.
  // Nothing if the iteration does not settle or the solution is not isolated.
  static std::optional<Model> ModelNear(const Eigen::Matrix3d& E, const Rays& rays1, const Rays& rays2);

  // E[0] ... E[count - 1], x2' E x1 = 0 in rays, Frobenius norm sqrt(2) as [t]x R has with |t| = 1; the sign
  // is arbitrary. In descending order of |E_33|: another implementation that finds the same ones numbers them
  // the same (kernels/block_source.h).
  struct Solutions {
    std::array<Eigen::Matrix3d, kMaxModels> E;
    int count = 0;
  };

  // Only isolated solutions count: none if the points are fewer than five different ones or not finite, and
  // none of a family such as that of a pure rotation (smallest pivot of M, or of the 5x5 Jacobian of the
  // equations at the solution, below 1e-9 of the largest). Allocates nothing.
  static Solutions Solve(const Rays& rays1, const Rays& rays2);
};

}  // namespace rcme
