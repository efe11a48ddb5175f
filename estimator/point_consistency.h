// Does a match agree with a motion? Three tests with one shape: built once per hypothesis, then called per
// match.
//
//   KnownPoseTest   the motion is taken as exact: g^2 / |J|^2 <= sigma^2 chi2_1 (Hartley & Zisserman, 4.7.1)
//   AsPrintedTest   eq::find-inlier read literally: delta' Sigma_delta^-1 delta <= chi2_3, in closed form
//   RankAwareTest   the residual has one dimension: g^2 / (|J|^2 s2) <= chi2_1
//
// Distance returns d2, the squared Mahalanobis distance; Entropy and NegativeLogLikelihood take what it left
// in the PointResidual. No allocation. Everything is in px, so sigma and s are px and entropies are nats of a
// density per px.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "estimator/geometry/sampson.h"
#include "estimator/motion_problem.h"

namespace rcme {

// The floor of a squared Sampson distance in units of sigma^2: the printed entropy stays finite at g = 0.
inline constexpr double kLeastSquaredDistance = 1e-60;

// The five derivatives of E along the principal axes of the motion's covariance: with L L' = Sigma_p, the
// k-th is sum_l L_lk dE/dp_l. Nothing if pose_cov is not finite and positive semi-definite.
std::optional<std::array<Eigen::Matrix3d, 5>> WhitenedTangent(const RelativePose& pose,
                                                              const Matrix5d& pose_cov);

// F and its five derivatives along the principal axes of the motion's covariance: with L L' = Sigma_p, the
// k-th is sum_l L_lk dF/dp_l, so that in these axes the motion's covariance is the identity.
struct UncertainFundamental {
  Eigen::Matrix3d F;
  std::array<Eigen::Matrix3d, 5> dF_whitened;

  // Nothing if pose_cov is not finite and positive semi-definite.
  static std::optional<UncertainFundamental> From(const RelativePose& pose, const Matrix5d& pose_cov,
                                                  const Camera& camera1, const Camera& camera2);
  // Of the covariance L L' (5x5, of any rank), along the columns of L. Nothing if L is not finite.
  static std::optional<UncertainFundamental> FromFactor(const RelativePose& pose, const Matrix5d& L,
                                                        const Camera& camera1, const Camera& camera2);
};

// The residual of one match in the one dimension it has: squared Sampson distance g^2 / |J|^2 and the
// variance of the signed distance that comes from the motion, g_p Sigma_p g_p' / |J|^2; both px^2.
struct MatchResidual {
  double squared_distance = 0.0;
  double motion_variance = 0.0;
};
MatchResidual EvaluateResidual(const UncertainFundamental& model, const Correspondence& match);

// What a test leaves of one match.
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
  double Entropy(const PointResidual&) const { return 0.0; }                // excess of an exact motion
  double NegativeLogLikelihood(const PointResidual&) const { return 0.0; }  // standard selects by count

 private:
  Eigen::Matrix3d F_;
  double sigma2_;
};

class AsPrintedTest {
 public:
  static constexpr bool kNeedsCovariance = true;
  static constexpr int kDegreesOfFreedom = 3;  // the paper's "4 - 1"
  // Each point of the sample has its own 3, unless its motion fits it perfectly.
  static constexpr int SampleTestDof(int solver_dof) { return solver_dof == 0 ? 0 : kDegreesOfFreedom; }
  // The entropy holds 3 log|g|: of a point that the model fits by construction rounding alone would say it.
  static constexpr bool kScoresExactFits = false;
  AsPrintedTest(const UncertainFundamental& model, double sigma_px);

  // Closed form, see the source; a singular Sigma_delta gives d2 = infinity: nothing can be said for the
  // match.
  double Distance(const Correspondence& match, PointResidual* residual) const;
  // h = 1/2 log((2 pi e)^4 det Sigma_delta) (eq. 15), det in px^8.
  static double EntropyOfLogDeterminant(double log_det_cov);
  double Entropy(const PointResidual& residual) const {
    return EntropyOfLogDeterminant(residual.log_det_cov);
  }
  // Not a density of the residual: no likelihood. Always zero.
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
  // Excess entropy 1/2 log(s2 / sigma^2) >= 0: what the motion's uncertainty adds to 1/2 log(2 pi e sigma^2).
  // No units.
  double Entropy(const PointResidual& residual) const { return 0.5 * (residual.log_det_cov - log_sigma2_); }
  // Of the signed residual under N(0, s2), in units of sigma: 1/2 d2 + 1/2 log(2 pi s2 / sigma^2).
  double NegativeLogLikelihood(const PointResidual& residual) const;

 private:
  UncertainFundamental model_;
  double sigma2_, log_sigma2_;
};

}  // namespace rcme
