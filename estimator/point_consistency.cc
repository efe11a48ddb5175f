#include "estimator/point_consistency.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numbers>

namespace rcme {
namespace {

constexpr double kLogTwoPi = 1.8378770664093454835606594728112;

// cov(j, g) of the gradient j and the constraint g is [[Q, a], [a', D]]: the noise of the match plus the
// motion's.
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

}  // namespace

std::optional<UncertainFundamental> UncertainFundamental::From(const RelativePose& pose,
                                                               const Matrix5d& pose_cov,
                                                               const Camera& camera1, const Camera& camera2) {
  // LDL' also takes a covariance that is singular, such as zero for a motion that is known.
  const Eigen::LDLT<Matrix5d> ldlt(pose_cov);
  if (!pose_cov.allFinite() || ldlt.info() != Eigen::Success || !ldlt.isPositive()) return std::nullopt;
  const Vector5d scale = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt();
  Matrix5d L = ldlt.matrixL();
  L = ldlt.transpositionsP().transpose() * L * scale.asDiagonal();

  UncertainFundamental model;
  model.F = FundamentalFromEssential(EssentialFromPose(pose), camera1, camera2);
  const std::array<Eigen::Matrix3d, 5> dE = EssentialTangent(pose);
  for (int k = 0; k < 5; ++k) {
    Eigen::Matrix3d whitened = Eigen::Matrix3d::Zero();
    for (int l = 0; l < 5; ++l) whitened += L(l, k) * dE[static_cast<size_t>(l)];
    model.dF_whitened[static_cast<size_t>(k)] = FundamentalFromEssential(whitened, camera1, camera2);
  }
  return model;
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

// The Sampson vector -j g / n2 (n2 = |j|^2) depends on the match and the motion through (j, g) alone. With
// the reflection P = I - 2 j j' / n2, Qt = Q - a a' / D and v = D j - g a,
//
//   n2^2 P Sigma_delta P = g^2 Qt + v v' / D,
//
// and the determinant lemma and Sherman-Morrison give, with s_xy = x' Qt^-1 y,
//
//   d2 = g^2 V / U,  U = D g^2 + s_vv,  V = D s_jj + s_jj s_aa - s_ja^2,  det Sigma_delta = g^6 det(Qt) U /
//   (D n2^8).
//
// Stable where the 4x4 inverse is not: nothing is divided by g.
double AsPrintedTest::Distance(const Correspondence& match, PointResidual* residual) const {
  const EpipolarConstraint c = EvaluateConstraint(model_.F, match);
  const ConstraintSpread spread = SpreadOfConstraint(model_, c, sigma2_, H_, point_noise_, match);
  const Eigen::LLT<Eigen::Matrix4d> llt(spread.Q - spread.a * spread.a.transpose() / spread.D);
  if (llt.info() != Eigen::Success) {
    residual->d2 = std::numeric_limits<double>::infinity();
    return residual->d2;
  }
  const Eigen::Vector4d y_j = llt.matrixL().solve(c.gradient);
  const Eigen::Vector4d y_a = llt.matrixL().solve(spread.a);
  const double U = spread.D * c.g * c.g + (spread.D * y_j - c.g * y_a).squaredNorm();
  const double s_ja = y_j.dot(y_a);
  const double V = spread.D * y_j.squaredNorm() + y_j.squaredNorm() * y_a.squaredNorm() - s_ja * s_ja;
  residual->d2 = c.g * c.g * V / U;

  const double log_det_Qt = 2.0 * std::log(llt.matrixLLT().diagonal().prod());
  const double abs_g =
      std::max(std::abs(c.g), std::numeric_limits<double>::min());  // g = 0 exactly: keep h finite
  residual->log_det_cov =
      6.0 * std::log(abs_g) + log_det_Qt + std::log(U / spread.D) - 8.0 * std::log(c.squared_gradient());
  return residual->d2;
}

double AsPrintedTest::Entropy(const PointResidual& residual) const {
  return 0.5 * (4.0 * (kLogTwoPi + 1.0) + residual.log_det_cov);
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
