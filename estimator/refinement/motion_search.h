// Levenberg-Marquardt over the five coordinates of a motion.
#pragma once

#include <functional>

#include "estimator/geometry/pose.h"

namespace rcme {

enum class Loss {
  kSquared,
  kCauchy,
};

// Scale of Cauchy's loss in units of sigma: 95 % efficient for Gaussian noise.
inline constexpr double kCauchyScale = 2.385;

struct RefinedMotion {
  bool converged = false;  // false: no finite optimum; the other fields are then the start
  RelativePose cam2_from_cam1;
  Matrix5d pose_cov = Matrix5d::Zero();
  int num_iterations = 0;
};

// The cost 1/2 sum rho(r^2) at a motion and its derivatives in the motion's tangent coordinates.
struct NormalEquations {
  double cost = 0.0;
  Vector5d gradient = Vector5d::Zero();  // sum rho' r r_p'
  // sum max(psi', 0.7 rho') r_p' r_p, psi = rho' r; for the squared loss that of Gauss-Newton. With rho' in
  // the place of psi' every step would leave a fifth of the error; psi' alone vanishes far from the optimum.
  // From the winners of 100 trials a factor of 0.25 took 9.4 evaluations, 0.5 5.6, 0.7 4.8, 0.8 5.0, 1 6.1.
  Matrix5d hessian = Matrix5d::Zero();
};

struct MotionCost {
  std::function<NormalEquations(const RelativePose&)> linearize;
  std::function<Matrix5d(const RelativePose&)> information;  // its inverse becomes pose_cov
  double negligible_decrease = 1e-9;                         // of the cost; see MinimizeOverMotion
};

// Minimises the cost from `start`. Converged when the next step, which is still taken, would lower the cost
// by less than d = `negligible_decrease`; that step is at most sqrt(2 d) standard deviations long.
RefinedMotion MinimizeOverMotion(const RelativePose& start, const MotionCost& cost);

}  // namespace rcme
