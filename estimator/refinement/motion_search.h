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

// Of a cost 1/2 sum rho(r^2) at a motion, in its tangent coordinates.
struct NormalEquations {
  double cost = 0.0;
  Vector5d gradient = Vector5d::Zero();     // sum rho' r r_p'
  Matrix5d hessian = Matrix5d::Zero();      // Gauss-Newton's, sum rho' r_p' r_p
  Matrix5d information = Matrix5d::Zero();  // sum g_p' g_p / var g; its inverse becomes pose_cov
};

// The optimum from `start`. Converged when the step that is left would lower the cost by less than a billionth: it
// is then shorter than 5e-5 standard deviations, and taken.
RefinedMotion MinimizeOverMotion(const RelativePose& start,
                                 const std::function<NormalEquations(const RelativePose&)>& linearize);

}  // namespace rcme
