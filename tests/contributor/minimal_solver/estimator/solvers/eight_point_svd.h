#pragma once

#include "estimator/solvers/minimal_solver.h"

namespace rcme {

// The 8-point algorithm of eight_point.h by a singular value decomposition in place of its Householder QR:
// the same model to rounding.
class EightPointSvd {
 public:
  static constexpr int kSampleSize = 8;
  static constexpr int kMaxModels = 1;
  static constexpr SolverCase kCase = SolverCase::kOverdetermined;  // 8 parameters, F has 7
  static constexpr int kSampleTestDof = 3;                          // 8 equations, the motion has 5
  using Rays = std::array<Eigen::Vector3d, kSampleSize>;
  using Model = MinimalModel<kSampleSize>;

  // M = U S [A f]', so that G = A (M A)^-1 = A S^-1 U'. None if the smallest singular value of M (8x9) is
  // below 1e-9 of the largest.
  static ModelList<Model, kMaxModels> FindModels(const Rays& rays1, const Rays& rays2);
};

}  // namespace rcme
