#pragma once

#include "estimator/solvers/minimal_solver.h"

namespace rcme {

// The motion of a car from one correspondence, the paper's own example of the exact case (Scaramuzza 2011).
//
// The model is Ackermann steering on a plane. The car moves along a circle about a point on the line of its
// rear axle, so a turn by the yaw angle theta goes with a direction of translation at theta / 2: one
// parameter, one equation.
//
// Frame: an upright camera above the middle of the rear axle, looking ahead, x to the right, y down, z
// forward. Positive theta turns to the right. In camera 1's frame camera 2 looks along (sin theta, 0, cos
// theta) and lies in the direction (sin h, 0, cos h), h = theta / 2. Hence cam2_from_cam1 is R = R_y(-theta),
// t = -R (sin h, 0, cos h) = (sin h, 0, -cos h), and
//
//   E = [t]x R = [[0, cos h, 0], [-cos h, 0, sin h], [0, sin h, 0]].
//
// With rays (u, v, 1), g = x2' E x1 = cos h (u2 v1 - u1 v2) + sin h (v1 + v2). This determines h up to a half
// turn, which changes only the sign of E (the car reverses).
//
// The covariance of the motion has rank 1, along the circle. Slip, a tilted camera or an uneven ground cause
// errors that no covariance describes.
class OnePoint {
 public:
  static constexpr int kSampleSize = 1;
  static constexpr int kMaxModels = 1;
  static constexpr SolverCase kCase = SolverCase::kExact;
  static constexpr int kSampleTestDof = 0;  // the motion fits its sample exactly
  using Rays = std::array<Eigen::Vector3d, kSampleSize>;
  using Model = MinimalModel<kSampleSize>;

  // f = vec(E) / sqrt(2), T = df/dh (unit).
  //
  // No model if the point does not determine h: both coefficients are below 1e-9 of the rays' lengths, as for
  // a point on the horizon (v1 = v2 = 0), which stays on the horizon under all these motions.
  static ModelList<Model, kMaxModels> FindModels(const Rays& rays1, const Rays& rays2);
};

}  // namespace rcme
