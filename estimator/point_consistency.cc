#include "estimator/point_consistency.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace rcme {
namespace {

constexpr double kLogTwoPi = 1.8378770664093454835606594728112;

// The covariance of the gradient j and the constraint g, [[Q, a], [a', D]], from the noise of the match and
// the uncertainty of the motion.
struct ConstraintSpread {
  Eigen::Matrix4d Q;
  Eigen::Vector4d a;
  double D;
};

ConstraintSpread SpreadOfConstraint(const UncertainFundamental& model, const EpipolarConstraint& constraint,
                                    double sigma2, const Eigen::Matrix4d& H,
                                    const Eigen::Matrix4d& point_noise, const Correspondence& match) {
  ConstraintSpread spread{point_noise, sigma2 * H * constraint.gradient,
                          sigma2 * constraint.squared_gradient()};
  for (const Eigen::Matrix3d& dF : model.dF_whitened) {
    const EpipolarConstraint derivative = EvaluateConstraint(dF, match);
    spread.Q += derivative.gradient * derivative.gradient.transpose();
    spread.a += derivative.g * derivative.gradient;
    spread.D += derivative.g * derivative.g;
  }
  return spread;
}

// A matrix L with L L' = cov: by Cholesky, or by eigenvectors if cov is singular to within rounding, such as
// zero for a known motion. nullopt if cov is not positive semi-definite.
std::optional<Matrix5d> ComputeSquareRoot(const Matrix5d& cov) {
  const Eigen::LLT<Matrix5d> llt(cov);
  if (llt.info() == Eigen::Success) return llt.matrixL();
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(cov);
  const Vector5d& variances = eigen.eigenvalues();
  if (eigen.info() != Eigen::Success || variances(0) < -1e-12 * std::abs(variances(4))) return std::nullopt;
  return eigen.eigenvectors() * variances.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

// 4x3 orthonormal basis of the complement of the unit vector u: the last three columns of the Householder
// reflection that takes u to the first axis.
Eigen::Matrix<double, 4, 3> ComputeComplement(const Eigen::Vector4d& u) {
  Eigen::Vector4d h = u;
  h(0) += u(0) < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix4d reflection =
      Eigen::Matrix4d::Identity() - (2.0 / h.squaredNorm()) * h * h.transpose();
  return reflection.rightCols<3>();
}

// The derivatives of E along the columns of L.
std::array<Eigen::Matrix3d, 5> TangentAlong(const RelativePose& pose, const Matrix5d& L) {
  const std::array<Eigen::Matrix3d, 5> dE = EssentialTangent(pose);
  std::array<Eigen::Matrix3d, 5> along;
  for (int k = 0; k < 5; ++k) {
    Eigen::Matrix3d& sum = along[static_cast<size_t>(k)];
    sum = Eigen::Matrix3d::Zero();
    for (int l = 0; l < 5; ++l) sum += L(l, k) * dE[static_cast<size_t>(l)];
  }
  return along;
}

UncertainFundamental FundamentalWith(const std::array<Eigen::Matrix3d, 5>& dE, const RelativePose& pose,
                                     const Camera& camera1, const Camera& camera2) {
  UncertainFundamental model;
  model.F = FundamentalFromEssential(EssentialFromPose(pose), camera1, camera2);
  for (size_t k = 0; k < 5; ++k) {
    model.dF_whitened[k] = FundamentalFromEssential(dE[k], camera1, camera2);
  }
  return model;
}

}  // namespace

std::optional<std::array<Eigen::Matrix3d, 5>> WhitenedTangent(const RelativePose& pose,
                                                              const Matrix5d& pose_cov) {
  if (!pose_cov.allFinite()) return std::nullopt;
  const std::optional<Matrix5d> root = ComputeSquareRoot(pose_cov);
  if (!root) return std::nullopt;
  return TangentAlong(pose, *root);
}

std::optional<UncertainFundamental> UncertainFundamental::From(const RelativePose& pose,
                                                               const Matrix5d& pose_cov,
                                                               const Camera& camera1, const Camera& camera2) {
  const std::optional<std::array<Eigen::Matrix3d, 5>> dE = WhitenedTangent(pose, pose_cov);
  if (!dE) return std::nullopt;
  return FundamentalWith(*dE, pose, camera1, camera2);
}

std::optional<UncertainFundamental> UncertainFundamental::FromFactor(const RelativePose& pose,
                                                                     const Matrix5d& L, const Camera& camera1,
                                                                     const Camera& camera2) {
  if (!L.allFinite()) return std::nullopt;
  return FundamentalWith(TangentAlong(pose, L), pose, camera1, camera2);
}

double KnownPoseTest::Distance(const Correspondence& match, PointResidual* residual) const {
  residual->d2 = SquaredSampsonDistance(F_, match) / sigma2_;
  return residual->d2;
}

AsPrintedTest::AsPrintedTest(const UncertainFundamental& model, double sigma_px)
    : model_(model),
      sigma2_(sigma_px * sigma_px),
      H_(ConstraintHessian(model.F)),
      point_noise_(sigma2_ * H_ * H_.transpose()) {}

// delta' Sigma_delta^-1 delta (eq::mahalanobis_dist_F) of the Sampson vector (eq::sampson_error_vec) and its
// covariance (eq::cov_sampson_error_vec), in closed form.
//
// The Sampson vector -j g / n2 (n2 = |j|^2) depends on the match and the motion through (j, g) alone, with
// cov(j, g) = [[Q, a], [a', D]]. With the reflection P = I - 2 j j' / n2,
//
//   n2^2 P Sigma_delta P = g^2 Q - g (a j' + j a') + D j j' =: S,   P delta = +j g / n2.
//
// In the orthonormal basis [u, W], u = j / n, S is [[s11, g r'], [g r, g^2 W'QW]] with
//
//   s11 = g^2 u'Qu - 2 g n u'a + n2 D,   r = W'(g Q u - n a),
//
// so that with the Schur complement c = s11 - r' (W'QW)^-1 r
//
//   d2 = g^2 n2 / c,   det Sigma_delta = g^6 det(W'QW) c / n2^8.
//
// There is no division by g. If the motion is known (Sigma_p = 0), W'QW stays regular while the 4x4 matrix is
// singular up to rounding. Then d2 = (|x1 - e1|^2 + |x2 - e2|^2) / sigma^2, e1 and e2 the epipoles,
// independent of the residual.
double AsPrintedTest::Distance(const Correspondence& match, PointResidual* residual) const {
  const EpipolarConstraint c = EvaluateConstraint(model_.F, match);
  const ConstraintSpread spread = SpreadOfConstraint(model_, c, sigma2_, H_, point_noise_, match);
  const double n2 = c.squared_gradient(), n = std::sqrt(n2);
  const Eigen::Vector4d u = c.gradient / n;
  const Eigen::Matrix<double, 4, 3> W = ComputeComplement(u);
  const Eigen::Vector4d Qu = spread.Q * u;
  const Eigen::Vector3d r = W.transpose() * (c.g * Qu - n * spread.a);
  const Eigen::LLT<Eigen::Matrix3d> llt(W.transpose() * spread.Q * W);
  const double s11 = c.g * c.g * u.dot(Qu) - 2.0 * c.g * n * u.dot(spread.a) + n2 * spread.D;
  const double schur = s11 - llt.matrixL().solve(r).squaredNorm();
  if (llt.info() != Eigen::Success || !(schur > 0.0)) {
    residual->d2 = std::numeric_limits<double>::infinity();
    return residual->d2;
  }
  residual->d2 = c.g * c.g * n2 / schur;
  const double g2 = std::max(c.g * c.g, kLeastSquaredDistance * sigma2_ * n2);
  residual->log_det_cov = 3.0 * std::log(g2) + 2.0 * std::log(llt.matrixLLT().diagonal().prod()) +
                          std::log(schur) - 8.0 * std::log(n2);
  return residual->d2;
}

// h (eq. 15).
double AsPrintedTest::EntropyOfLogDeterminant(double log_det_cov) {
  return 0.5 * (4.0 * (kLogTwoPi + 1.0) + log_det_cov);
}

MatchResidual EvaluateResidual(const UncertainFundamental& model, const Correspondence& match) {
  const EpipolarConstraint c = EvaluateConstraint(model.F, match);
  double variance_of_g = 0.0;  // g_p Sigma_p g_p'
  for (const Eigen::Matrix3d& dF : model.dF_whitened) {
    const double g_p = match.x2_px.homogeneous().dot(dF * match.x1_px.homogeneous());
    variance_of_g += g_p * g_p;
  }
  const double n2 = c.squared_gradient();
  return {c.g * c.g / n2, variance_of_g / n2};
}

double RankAwareTest::Distance(const Correspondence& match, PointResidual* residual) const {
  const MatchResidual match_residual = EvaluateResidual(model_, match);
  const double s2 = sigma2_ + match_residual.motion_variance;
  residual->d2 = match_residual.squared_distance / s2;
  residual->log_det_cov = std::log(s2);
  return residual->d2;
}

double RankAwareTest::NegativeLogLikelihood(const PointResidual& residual) const {
  return 0.5 * (residual.d2 + kLogTwoPi + residual.log_det_cov - log_sigma2_);
}

}  // namespace rcme
