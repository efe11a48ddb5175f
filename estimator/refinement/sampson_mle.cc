#include "estimator/refinement/sampson_mle.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "estimator/geometry/sampson.h"

namespace rcme {
namespace {

constexpr int kMaxIterations = 50;

// The normal equations of 1/2 sum r^2, r = g / (sigma |J|), at a motion.
struct NormalEquations {
  double cost = 0.0;
  Vector5d gradient = Vector5d::Zero();
  Matrix5d hessian = Matrix5d::Zero();      // Gauss-Newton's
  Matrix5d information = Matrix5d::Zero();  // sum g_p' g_p / var g
};

NormalEquations Linearize(const MotionProblem& problem, const RelativePose& pose) {
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2);
  std::array<Eigen::Matrix3d, 5> dF_dp = EssentialTangent(pose);
  for (Eigen::Matrix3d& dF : dF_dp) dF = FundamentalFromEssential(dF, problem.camera1, problem.camera2);

  NormalEquations equations;
  for (const Correspondence& match : problem.matches) {
    const EpipolarConstraint c = EvaluateConstraint(F, match);
    const double n2 = c.squared_gradient(), unit = 1.0 / (problem.sigma_px * std::sqrt(n2));
    const double r = unit * c.g;
    Vector5d g_p, r_p;  // r_p = unit (g_p - g J J_p / |J|^2)
    for (int k = 0; k < 5; ++k) {
      const EpipolarConstraint derivative = EvaluateConstraint(dF_dp[static_cast<size_t>(k)], match);
      g_p(k) = unit * derivative.g;
      r_p(k) = g_p(k) - r * c.gradient.dot(derivative.gradient) / n2;
    }
    equations.cost += 0.5 * r * r;
    equations.gradient += r * r_p;
    equations.hessian += r_p * r_p.transpose();
    equations.information += g_p * g_p.transpose();
  }
  return equations;
}

}  // namespace

RefinedMotion RefineBySampson(const MotionProblem& problem, const RelativePose& start) {
  RefinedMotion result{.cam2_from_cam1 = start};
  NormalEquations at = Linearize(problem, start);
  double damping = 1e-3;
  for (; result.num_iterations < kMaxIterations && !result.converged; ++result.num_iterations) {
    Matrix5d damped = at.hessian;
    damped.diagonal() *= 1.0 + damping;
    const Vector5d step = -damped.ldlt().solve(at.gradient);
    if (!step.allFinite()) break;
    const RelativePose moved = Retract(result.cam2_from_cam1, step);
    const NormalEquations there = Linearize(problem, moved);
    // Along this step the cost is worth less than a billionth of a standard deviation squared.
    result.converged = -step.dot(at.gradient) < 1e-9;
    if (there.cost < at.cost) {
      result.cam2_from_cam1 = moved;
      at = there;
      damping *= 0.1;
    } else {
      damping *= 10.0;
    }
  }
  const Eigen::LLT<Matrix5d> llt(at.information);
  if (!result.converged || llt.info() != Eigen::Success) return {.cam2_from_cam1 = start};
  result.pose_cov = llt.solve(Matrix5d::Identity());
  return result;
}

}  // namespace rcme
