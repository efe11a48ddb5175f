#include "estimator/refinement/sampson_equations.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "estimator/geometry/sampson.h"
#include "estimator/noise_scale.h"

namespace rcme {
namespace {

// rho(r^2), rho' and max(psi', 0.7 rho') with psi = rho' r; see NormalEquations.
struct LossTerms {
  double rho, weight, curvature;
};
LossTerms EvaluateLoss(double r, Loss loss) {
  if (loss == Loss::kSquared) return {r * r, 1.0, 1.0};
  const double c2 = kCauchyScale * kCauchyScale;
  const double weight = 1.0 / (1.0 + r * r / c2);
  const double psi_slope = weight * weight * (1.0 - r * r / c2);
  return {c2 * std::log1p(r * r / c2), weight, std::max(psi_slope, 0.7 * weight)};
}

}  // namespace

SampsonLinearization::SampsonLinearization(const MotionProblem& problem, const RelativePose& pose)
    : sigma_px_(problem.sigma_px),
      F_(FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2)),
      dF_(EssentialTangent(pose)) {
  for (Eigen::Matrix3d& d : dF_) d = FundamentalFromEssential(d, problem.camera1, problem.camera2);
}

SampsonResidual SampsonLinearization::Evaluate(const Correspondence& match, double noise_scale) const {
  const double sigma_px = sigma_px_ * noise_scale;
  const EpipolarConstraint c = EvaluateConstraint(F_, match);
  const double length = c.gradient.norm();
  SampsonResidual residual{.r = c.g / (sigma_px * length), .norm = sigma_px * length, .g_p = {}, .r_p = {}};
  for (int k = 0; k < 5; ++k) {
    const EpipolarConstraint d = EvaluateConstraint(dF_[static_cast<size_t>(k)], match);
    const double d_length = c.gradient.dot(d.gradient) / length;
    residual.g_p(k) = d.g;
    residual.r_p(k) = d.g / residual.norm - residual.r * d_length / length;
  }
  return residual;
}

SampsonScore SampsonLinearization::Score(const Correspondence& match, double noise_scale) const {
  const EpipolarConstraint c = EvaluateConstraint(F_, match);
  const double norm = sigma_px_ * noise_scale * c.gradient.norm();
  SampsonScore score{.r = c.g / norm, .norm = norm, .g_p = {}, .gradient = c.gradient};
  const Eigen::Vector3d x1 = match.x1_px.homogeneous(), x2 = match.x2_px.homogeneous();
  for (int k = 0; k < 5; ++k) {
    const Eigen::Vector3d line = dF_[static_cast<size_t>(k)] * x1;
    score.g_p(k) = x2.dot(line);
  }
  return score;
}

NormalEquations LinearizeSampson(const MotionProblem& problem, std::span<const int> indices,
                                 const RelativePose& pose, Loss loss) {
  const SampsonLinearization model(problem, pose);
  NormalEquations equations;
  for (const int index : indices) {
    const auto i = static_cast<size_t>(index);
    const SampsonResidual residual = model.Evaluate(problem.matches[i], NoiseScaleAt(problem, i));
    const LossTerms terms = EvaluateLoss(residual.r, loss);
    equations.cost += 0.5 * terms.rho;
    equations.gradient += terms.weight * residual.r * residual.r_p;
    equations.hessian += terms.curvature * residual.r_p * residual.r_p.transpose();
  }
  return equations;
}

Matrix5d SampsonInformation(const MotionProblem& problem, std::span<const int> indices,
                            const RelativePose& pose) {
  const SampsonLinearization model(problem, pose);
  Matrix5d information = Matrix5d::Zero();
  for (const int index : indices) {
    const auto i = static_cast<size_t>(index);
    const SampsonResidual residual = model.Evaluate(problem.matches[i], NoiseScaleAt(problem, i));
    const Vector5d row = residual.g_p / residual.norm;
    information += row * row.transpose();
  }
  return information;
}

}  // namespace rcme
