#include "estimator/calibrated/mode_covariance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <functional>

namespace rcme {
namespace {

Vector5d DerivativeOf(const MatchTermLists& terms, size_t i) {
  Vector5d J;
  for (size_t k = 0; k < 5; ++k) J(static_cast<Eigen::Index>(k)) = terms.derivative[k][i];
  return J;
}

// The Hessian of -log_likelihood to first order in the residuals' second derivatives, without the bound that
// keeps each match's part positive; the mode's own where that is not positive.
Matrix5d InverseOfHessian(const Mode& mode, const Explanation& e) {
  Matrix5d hessian = Matrix5d::Zero();
  const MixtureParameters& m = mode.mixture;
  for (size_t i = 0; i < e.probability.size(); ++i) {
    if (!(mode.used[i / kBlockSize] >> (i % kBlockSize) & 1)) continue;
    const double u = e.terms.residual[i] / m.scale, v = NoiseWeight(m.noise, u), p = e.probability[i];
    const double bend = 2.0 / (1.0 + u * u / m.noise.dof()) - 1.0;
    const double curvature = p * v * (bend - (1.0 - p) * v * u * u) / (m.scale * m.scale);
    const Vector5d J = DerivativeOf(e.terms, i);
    hessian += curvature * J * J.transpose();
  }
  const Eigen::LLT<Matrix5d> llt(hessian);
  if (llt.info() != Eigen::Success) return mode.inverse_hessian;
  const Matrix5d inverse = llt.solve(Matrix5d::Identity());
  return inverse.allFinite() ? inverse : mode.inverse_hessian;
}

}  // namespace

Matrix5d SandwichCovariance(const Mode& mode, const Explanation& e) {
  const MixtureParameters& m = mode.mixture;
  Matrix5d scores = Matrix5d::Zero();
  for (size_t i = 0; i < e.probability.size(); ++i) {
    if (!(mode.used[i / kBlockSize] >> (i % kBlockSize) & 1)) continue;
    const double u = e.terms.residual[i] / m.scale;
    const double psi = e.probability[i] * NoiseWeight(m.noise, u) * u;
    const double factor = psi / (std::max(1.0 - e.leverage[i], 0.05) * m.scale);
    const Vector5d J = DerivativeOf(e.terms, i);
    scores += factor * factor * J * J.transpose();
  }
  const Matrix5d inverse = InverseOfHessian(mode, e);
  const Matrix5d covariance = inverse * scores * inverse;
  return covariance.allFinite() ? covariance : mode.inverse_hessian;
}

Matrix5d IntrinsicsCovariance(const MotionProblem& problem, const CalibratedOptions& options,
                              const Mode& mode) {
  Matrix5d sum = Matrix5d::Zero();
  const auto gradient_of = [&](const MotionProblem& changed) {
    return SumMixture(MatchBlocks(changed), mode.used, mode.pose, mode.mixture).gradient;
  };
  const Vector5d base = gradient_of(problem);
  const auto add = [&](const std::function<void(MotionProblem&)>& change) {
    MotionProblem changed = problem;
    change(changed);
    const Vector5d moved = -mode.inverse_hessian * (gradient_of(changed) - base);
    sum += moved * moved.transpose();
  };
  const auto scale_focal = [&](Camera& camera) {
    camera.fx *= 1.0 + options.focal_sd;
    camera.fy *= 1.0 + options.focal_sd;
  };
  const bool is_one_camera = problem.camera1.K() == problem.camera2.K();
  if (options.focal_sd > 0.0 && is_one_camera) {
    add([&](MotionProblem& p) { scale_focal(p.camera1), scale_focal(p.camera2); });
  } else if (options.focal_sd > 0.0) {
    add([&](MotionProblem& p) { scale_focal(p.camera1); });
    add([&](MotionProblem& p) { scale_focal(p.camera2); });
  }
  const double shift = options.principal_point_sd_px;
  if (!(shift > 0.0)) return sum;
  for (double Camera::*coordinate : {&Camera::cx, &Camera::cy}) {
    if (is_one_camera) {
      add([&](MotionProblem& p) { p.camera1.*coordinate += shift, p.camera2.*coordinate += shift; });
    } else {
      add([&](MotionProblem& p) { p.camera1.*coordinate += shift; });
      add([&](MotionProblem& p) { p.camera2.*coordinate += shift; });
    }
  }
  return sum;
}

}  // namespace rcme
