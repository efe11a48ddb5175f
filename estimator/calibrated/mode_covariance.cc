#include "estimator/calibrated/mode_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numbers>

#include "estimator/calibrated/influence.h"

namespace rcme {
namespace {

// Lower bound of the ratio of the observed curvature to that without the residuals' second derivatives. A
// smaller ratio is noise: the likelihood has no optimum along that direction.
constexpr double kLeastCurvature = 0.1;
// Factor of ProbabilityWrong, which is twice too great for the many matches whose probability is a few
// percent.
constexpr double kDoubt = 0.5;
constexpr double kFew = 30.0;

Vector5d ReadDerivative(const MatchTermLists& terms, size_t i) {
  Vector5d J;
  for (size_t k = 0; k < 5; ++k) J(static_cast<Eigen::Index>(k)) = terms.derivative[k][i];
  return J;
}

// The least matrix that is no smaller than a or b along any direction in which they are compared.
Matrix5d ComputeLeastUpperBound(const Matrix5d& a, const Matrix5d& b) {
  const Eigen::LLT<Matrix5d> llt(b);
  if (llt.info() != Eigen::Success) return a;
  const Matrix5d L = llt.matrixL();
  const Matrix5d half = L.triangularView<Eigen::Lower>().solve(a);
  const Matrix5d ratio = L.triangularView<Eigen::Lower>().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(ratio);
  const Matrix5d root = L * eigen.eigenvectors();
  return root * eigen.eigenvalues().cwiseMax(1.0).asDiagonal() * root.transpose();
}

// Widens the covariance root root' along each principal axis by k / (k - 2). k is the effective number of
// matches of the axis if that is below kFew, else the degrees of freedom of the whole. It works on the root,
// so that rounding cannot make the result indefinite.
Matrix5d WidenedForFew(const Matrix5d& root, const Matrix5d& inverse, const Mode& mode, const Explanation& e,
                       double freedom) {
  const Matrix5d axes =
      Eigen::SelfAdjointEigenSolver<Matrix5d>(Matrix5d(root * root.transpose())).eigenvectors();
  const Vector5d effective = EffectiveMatches(mode, e, inverse * axes);
  Vector5d factor;
  for (int axis = 0; axis < 5; ++axis) {
    const double k = std::max(effective(axis) < kFew ? std::min(effective(axis), freedom) : freedom, 3.0);
    factor(axis) = std::sqrt(k / (k - 2.0));
  }
  const Matrix5d widened = axes * factor.asDiagonal() * axes.transpose() * root;
  return widened * widened.transpose();
}

}  // namespace

Matrix5d InverseOfObserved(const MatchBlocks& matches, const Mode& mode, const MixturePrior& prior) {
  const auto gradient_at = [&](const Vector5d& step) -> Vector5d {
    const RelativePose moved = Retract(mode.pose, step);
    return TransportTangent(moved, mode.pose) *
           SumPosteriorGradient(matches, mode.used, prior, moved, mode.mixture);
  };
  const Matrix5d root = mode.inverse_hessian.llt().matrixL();
  Matrix5d whitened;
  constexpr double kStep = 0.1;
  for (int k = 0; k < 5; ++k) {
    const Vector5d step = kStep * root.col(k);
    const Vector5d ahead = gradient_at(step), behind = gradient_at(-step);
    whitened.col(k) = root.transpose() * (ahead - behind) / (2.0 * kStep);
  }
  const Matrix5d symmetric = 0.5 * (whitened + whitened.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(symmetric);
  const Matrix5d back = root * eigen.eigenvectors();
  return back * eigen.eigenvalues().cwiseMax(kLeastCurvature).cwiseInverse().asDiagonal() * back.transpose();
}

Vector5d EffectiveMatches(const Mode& mode, const Explanation& e, const Matrix5d& axes) {
  Vector5d sum = Vector5d::Zero(), sum_squares = Vector5d::Zero();
  for (size_t i = 0; i < e.probability.size(); ++i) {
    if (!(mode.used[i / kBlockSize] >> (i % kBlockSize) & 1)) continue;
    const Vector5d part = e.probability[i] * (axes.transpose() * ReadDerivative(e.terms, i)).cwiseAbs2();
    sum += part;
    sum_squares += part.cwiseAbs2();
  }
  return sum.cwiseAbs2().cwiseQuotient(sum_squares);
}

Matrix5d SandwichCovariance(const Mode& mode, const Explanation& e, const Matrix5d& inverse) {
  const MixtureParameters& m = mode.mixture;
  Matrix5d scores = Matrix5d::Zero(), geometry = Matrix5d::Zero(), doubt = Matrix5d::Zero();
  const std::vector<double> wrong = WrongByInfluence(mode, e);
  double sum_squares = 0.0, num_right = 0.0;
  for (size_t i = 0; i < e.probability.size(); ++i) {
    if (!(mode.used[i / kBlockSize] >> (i % kBlockSize) & 1)) continue;
    const double u = e.terms.residual[i] / m.scale;
    const double psi = e.probability[i] * NoiseWeight(m.noise, u) * u;
    const double factor = psi / (std::sqrt(std::max(1.0 - e.leverage[i], 0.05)) * m.scale);
    const Vector5d J = ReadDerivative(e.terms, i);
    const Matrix5d outer = J * J.transpose();
    scores += factor * factor * outer;
    geometry += e.probability[i] * outer;
    const double kept = std::max(1.0 - e.leverage[i], 0.01);
    const double information = e.probability[i] * NoiseWeight(m.noise, u);
    doubt +=
        kDoubt * wrong[i] * (psi * psi / (kept * kept) + information / kept) / (m.scale * m.scale) * outer;
    sum_squares += psi * psi / (m.scale * m.scale);
    num_right += e.probability[i];
  }
  const double freedom = std::max(num_right - 5.0, 1.0);
  const Matrix5d equal = sum_squares / freedom * geometry;
  scores = ComputeLeastUpperBound(scores, equal) + doubt;
  // From a root of the middle factor: a few matches leave a direction so uncertain that rounding would make
  // the product indefinite.
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(scores);
  const Matrix5d root =
      inverse * eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const Matrix5d covariance = WidenedForFew(root, inverse, mode, e, freedom);
  return covariance.allFinite() ? covariance : mode.inverse_hessian;
}

Matrix5d PriorCovariance(const Mode& mode, const MixturePrior& prior, const Matrix5d& inverse) {
  if (prior.motion == nullptr) return Matrix5d::Zero();
  return inverse * EvaluatePrior(*prior.motion, mode.pose).hessian * inverse;
}

Matrix5d CovarianceWithPrior(const Matrix5d& covariance_of_matches, const Mode& mode,
                             const MixturePrior& prior) {
  if (prior.motion == nullptr) return covariance_of_matches;
  const Matrix5d of_prior = EvaluatePrior(*prior.motion, mode.pose).hessian;
  const Matrix5d kept = mode.inverse_hessian * (mode.hessian - of_prior);
  return kept * covariance_of_matches * kept.transpose() + PriorCovariance(mode, prior, mode.inverse_hessian);
}

Matrix5d BoundByUniformMotion(Matrix5d covariance) {
  constexpr double kMost = 1e6;  // rad^2; greater variances would only add rounding
  constexpr double kPi2 = std::numbers::pi * std::numbers::pi;
  Vector5d uniform;
  uniform << Eigen::Vector3d::Constant(kPi2 / 9.0 + 2.0 / 3.0), Eigen::Vector2d::Constant((kPi2 - 4.0) / 4.0);
  if (!(covariance.trace() < kMost)) {
    const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(covariance);
    const Vector5d variances = eigen.eigenvalues().cwiseMax(0.0).cwiseMin(kMost);
    covariance = eigen.eigenvectors() * variances.asDiagonal() * eigen.eigenvectors().transpose();
  }
  // (C^-1 + U^-1)^-1 = K U, K = C (C + U)^-1, as (I - K) C (I - K)' + K U K', which rounding keeps positive.
  const Matrix5d U = uniform.asDiagonal();
  const Matrix5d K = (covariance + U).llt().solve(covariance).transpose();
  const Matrix5d rest = Matrix5d::Identity() - K;
  const Matrix5d bounded = rest * covariance * rest.transpose() + K * U * K.transpose();
  return bounded.allFinite() ? bounded : U;
}

Matrix5d IntrinsicsCovariance(const MotionProblem& problem, const CalibrationPrior& calibration,
                              const Mode& mode, const Matrix5d& inverse_of_observed) {
  return CalibrationCovariance(problem, calibration, inverse_of_observed, [&](const MotionProblem& changed) {
    return SumMixtureGradient(MatchBlocks(changed), mode.used, mode.pose, mode.mixture);
  });
}

}  // namespace rcme
