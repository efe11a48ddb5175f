#include "estimator/calibrated/mode_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <functional>

namespace rcme {
namespace {

Vector5d DerivativeOf(const MatchTermLists& terms, size_t i) {
  Vector5d J;
  for (size_t k = 0; k < 5; ++k) J(static_cast<Eigen::Index>(k)) = terms.derivative[k][i];
  return J;
}

// The least matrix that is as great as both along every direction in which they are compared.
Matrix5d GreaterOf(const Matrix5d& a, const Matrix5d& b) {
  const Eigen::LLT<Matrix5d> llt(b);
  if (llt.info() != Eigen::Success) return a;
  const Matrix5d L = llt.matrixL();
  const Matrix5d half = L.triangularView<Eigen::Lower>().solve(a);
  const Matrix5d ratio = L.triangularView<Eigen::Lower>().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(ratio);
  const Matrix5d root = L * eigen.eigenvectors();
  return root * eigen.eigenvalues().cwiseMax(1.0).asDiagonal() * root.transpose();
}

// The Hessian by central differences of the gradient, a tenth of a standard deviation either way.
Matrix5d InverseOfObserved(const MatchBlocks& matches, const Mode& mode) {
  const Matrix5d root = mode.inverse_hessian.llt().matrixL();
  Matrix5d whitened;
  constexpr double kStep = 0.1;
  for (int k = 0; k < 5; ++k) {
    const Vector5d step = kStep * root.col(k);
    const Vector5d ahead = SumMixture(matches, mode.used, Retract(mode.pose, step), mode.mixture).gradient;
    const Vector5d behind = SumMixture(matches, mode.used, Retract(mode.pose, -step), mode.mixture).gradient;
    whitened.col(k) = root.transpose() * (ahead - behind) / (2.0 * kStep);
  }
  const Matrix5d symmetric = 0.5 * (whitened + whitened.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(symmetric);
  const Matrix5d back = root * eigen.eigenvectors();
  return back * eigen.eigenvalues().cwiseMax(0.1).cwiseInverse().asDiagonal() * back.transpose();
}

}  // namespace

Matrix5d SandwichCovariance(const MatchBlocks& matches, const Mode& mode, const Explanation& e) {
  const MixtureParameters& m = mode.mixture;
  Matrix5d scores = Matrix5d::Zero(), geometry = Matrix5d::Zero();
  double sum_squares = 0.0, num_right = 0.0;
  for (size_t i = 0; i < e.probability.size(); ++i) {
    if (!(mode.used[i / kBlockSize] >> (i % kBlockSize) & 1)) continue;
    const double u = e.terms.residual[i] / m.scale;
    const double psi = e.probability[i] * NoiseWeight(m.noise, u) * u;
    const double factor = psi / (std::max(1.0 - e.leverage[i], 0.05) * m.scale);
    const Vector5d J = DerivativeOf(e.terms, i);
    const Matrix5d outer = J * J.transpose();
    scores += factor * factor * outer;
    geometry += e.probability[i] * outer;
    sum_squares += psi * psi / (m.scale * m.scale);
    num_right += e.probability[i];
  }
  const double freedom = std::max(num_right - 5.0, 1.0);
  const Matrix5d equal = sum_squares / freedom * geometry;
  scores = GreaterOf(scores, equal);
  const Matrix5d inverse = InverseOfObserved(matches, mode);
  const Matrix5d covariance = freedom / std::max(freedom - 2.0, 1.0) * inverse * scores * inverse;
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
