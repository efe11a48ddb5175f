// Three tests whether a match agrees with a motion. Each is built once per hypothesis and called per match.
//
//   KnownPoseTest   the motion is taken as exact: g^2 / |J|^2 <= sigma^2 chi2_1 (Hartley & Zisserman, 4.7.1)
//   AsPrintedTest   eq::find-inlier as printed: delta' Sigma_delta^-1 delta <= chi2_3, in closed form
//   RankAwareTest   the residual has one dimension: g^2 / (|J|^2 s2) <= chi2_1
//
// Distance returns the squared Mahalanobis distance d2 and fills the PointResidual, from which Entropy and
// NegativeLogLikelihood are computed. Nothing allocates. Lengths, sigma and s are in px; entropies are nats
// of a density per px.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "estimator/geometry/sampson.h"

namespace rcme {

// Floor of the squared Sampson distance, in units of sigma^2: it keeps the printed entropy finite at g = 0.
inline constexpr double kLeastSquaredDistance = 1e-60;

// The derivatives of E along the five principal axes of the motion's covariance: with L L' = Sigma_p the k-th
// is sum_l L_lk dE/dp_l. nullopt if pose_cov is not finite and positive semi-definite.
std::optional<std::array<Eigen::Matrix3d, 5>> WhitenedTangent(const RelativePose& pose,
                                                              const Matrix5d& pose_cov);

// F and its derivatives along the five principal axes of the motion's covariance: with L L' = Sigma_p the
// k-th is sum_l L_lk dF/dp_l. In these axes the motion's covariance is the identity.
struct UncertainFundamental {
  Eigen::Matrix3d F;
  std::array<Eigen::Matrix3d, 5> dF_whitened;

  // nullopt if pose_cov is not finite and positive semi-definite.
  static std::optional<UncertainFundamental> From(const RelativePose& pose, const Matrix5d& pose_cov,
                                                  const Camera& camera1, const Camera& camera2);
  // For the covariance L L' (5x5, of any rank), along the columns of L. nullopt if L is not finite.
  static std::optional<UncertainFundamental> FromFactor(const RelativePose& pose, const Matrix5d& L,
                                                        const Camera& camera1, const Camera& camera2);
};

// The residual of one match in its single dimension, both in px^2: the squared Sampson distance g^2 / |J|^2,
// and the variance g_p Sigma_p g_p' / |J|^2 that the motion's uncertainty adds to the signed distance.
struct MatchResidual {
  double squared_distance = 0.0;
  double motion_variance = 0.0;
};
MatchResidual EvaluateResidual(const UncertainFundamental& model, const Correspondence& match);

// What a test computes for one match.
struct PointResidual {
  double d2 = 0.0;           // squared Mahalanobis distance
  double log_det_cov = 0.0;  // log det Sigma_delta (as printed), log s2 (rank-aware); known pose: unused
};

class KnownPoseTest {
 public:
  static constexpr bool kNeedsCovariance = false;
  static constexpr int kDegreesOfFreedom = 1;
  static constexpr int SampleTestDof(int solver_dof) { return solver_dof; }
  static constexpr bool kScoresExactFits = true;
  KnownPoseTest(const Eigen::Matrix3d& F, double sigma_px) : F_(F), sigma2_(sigma_px * sigma_px) {}
  double Distance(const Correspondence& match, PointResidual* residual) const;
  double Entropy(const PointResidual&) const { return 0.0; }  // excess entropy of an exact motion
  double NegativeLogLikelihood(const PointResidual&) const { return 0.0; }  // unused by `standard`

 private:
  Eigen::Matrix3d F_;
  double sigma2_;
};

class AsPrintedTest {
 public:
  static constexpr bool kNeedsCovariance = true;
  static constexpr int kDegreesOfFreedom = 3;  // the paper's "4 - 1"
  // Each point of the sample is tested with 3, unless the motion fits the sample exactly.
  static constexpr int SampleTestDof(int solver_dof) { return solver_dof == 0 ? 0 : kDegreesOfFreedom; }
  // The entropy contains 3 log|g|. For points that the model fits by construction this would be rounding
  // error.
  static constexpr bool kScoresExactFits = false;
  AsPrintedTest(const UncertainFundamental& model, double sigma_px);

  // Closed form, derived in the source. A singular Sigma_delta gives d2 = infinity: the match is no inlier.
  double Distance(const Correspondence& match, PointResidual* residual) const;
  // h = 1/2 log((2 pi e)^4 det Sigma_delta) (eq. 15), det in px^8.
  static double EntropyOfLogDeterminant(double log_det_cov);
  double Entropy(const PointResidual& residual) const {
    return EntropyOfLogDeterminant(residual.log_det_cov);
  }
  // Always zero: the printed distance is not based on a density of the residual.
  double NegativeLogLikelihood(const PointResidual&) const { return 0.0; }

 private:
  UncertainFundamental model_;
  double sigma2_;
  Eigen::Matrix4d H_;            // Hessian of g
  Eigen::Matrix4d point_noise_;  // sigma^2 H H'
};

class RankAwareTest {
 public:
  static constexpr bool kNeedsCovariance = true;
  static constexpr int kDegreesOfFreedom = 1;
  static constexpr int SampleTestDof(int solver_dof) { return solver_dof; }
  static constexpr bool kScoresExactFits = true;
  RankAwareTest(const UncertainFundamental& model, double sigma_px)
      : model_(model), sigma2_(sigma_px * sigma_px), log_sigma2_(std::log(sigma2_)) {}

  // d2 = g^2 / (|J|^2 s2), s2 = sigma^2 + g_p Sigma_p g_p' / |J|^2.
  double Distance(const Correspondence& match, PointResidual* residual) const;
  // Excess entropy 1/2 log(s2 / sigma^2) >= 0, without unit: what the motion's uncertainty adds to the
  // entropy 1/2 log(2 pi e sigma^2) of the noise.
  double Entropy(const PointResidual& residual) const { return 0.5 * (residual.log_det_cov - log_sigma2_); }
  // The negative log-density of the signed residual under N(0, s2), in units of sigma: 1/2 d2 + 1/2 log(2 pi
  // s2 / sigma^2).
  double NegativeLogLikelihood(const PointResidual& residual) const;

 private:
  UncertainFundamental model_;
  double sigma2_, log_sigma2_;
};

}  // namespace rcme
