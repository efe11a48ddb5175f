#include "experiments/trial/answer_check.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "peers/outside_answer.h"

namespace rcme {
namespace {

using Description = std::optional<std::string>;  // what is wrong; empty if nothing is

bool IsKnown(MotionStatus status) {
  const std::vector<MotionStatus>& all = AllStatuses();
  return std::find(all.begin(), all.end(), status) != all.end();
}

Description FaultOfInliers(const std::vector<int>& inliers, size_t num_matches) {
  std::vector<bool> is_taken(num_matches);
  for (const int index : inliers) {
    if (index < 0 || static_cast<size_t>(index) >= num_matches)
      return fmt::format("inlier {} is not an index of one of the {} matches", index, num_matches);
    if (is_taken[static_cast<size_t>(index)]) return fmt::format("inlier {} is there twice", index);
    is_taken[static_cast<size_t>(index)] = true;
  }
  return std::nullopt;
}

Description FaultOfCounts(const MotionEstimate& e, size_t num_matches) {
  const LoopCounts& c = e.counts;
  for (const auto& [name, count] : {std::pair{"num_support", e.num_support},
                                    {"num_consistent_before", e.num_consistent_before},
                                    {"num_consistent_after", e.num_consistent_after},
                                    {"num_explained", e.num_explained}}) {
    if (count < 0 || static_cast<size_t>(count) > num_matches)
      return fmt::format("{} is {} of {} matches", name, count, num_matches);
  }
  for (const int count : {c.num_hypotheses, c.num_degenerate_samples, c.num_inconsistent_samples,
                          c.num_poor_inlier_sets, c.num_too_small_inlier_sets, c.num_candidates}) {
    if (count < 0) return fmt::format("the number of hypotheses of one kind is {}", count);
  }
  return std::nullopt;
}

// NaN means that none is stated.
Description FaultOfProbabilities(const MotionEstimate& e, size_t num_matches) {
  const auto is_probability = [](double p) { return p >= 0.0 && p <= 1.0; };
  if (!std::isnan(e.failure_probability) && !is_probability(e.failure_probability))
    return fmt::format("failure_probability is {}", e.failure_probability);
  for (const double sigma : {e.sigma_estimated_px, e.sigma_estimated_sd_px}) {
    if (sigma < 0.0) return fmt::format("an estimate of sigma or its standard deviation is {} px", sigma);
  }
  const std::vector<double>& p = e.inlier_probabilities;
  if (!p.empty() && p.size() != num_matches)
    return fmt::format("{} inlier probabilities of {} matches", p.size(), num_matches);
  if (!std::ranges::all_of(p, is_probability)) return Description("an inlier probability is outside [0, 1]");
  return std::nullopt;
}

// Checks everything except the motion and its covariance.
Description FaultOfAccount(const MotionEstimate& estimate, size_t num_matches) {
  if (!IsKnown(estimate.status))
    return fmt::format("status {} is not a known status", static_cast<int>(estimate.status));
  if (const Description inliers = FaultOfInliers(estimate.inliers, num_matches)) return inliers;
  if (const Description counts = FaultOfCounts(estimate, num_matches)) return counts;
  return FaultOfProbabilities(estimate, num_matches);
}

Description FaultOfMotion(const MotionEstimate& estimate) {
  const Eigen::Matrix3d& R = estimate.cam2_from_cam1.R;
  const Eigen::Vector3d& t = estimate.cam2_from_cam1.t;
  const bool has_direction = estimate.status == MotionStatus::kOk;
  if (!has_direction && estimate.status != MotionStatus::kDirectionNotObservable) return std::nullopt;
  if (!IsRotation(R)) {
    return fmt::format("R is not a rotation: largest entry of |R'R - I| {:.3g}, det R {:.3g}",
                       (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(),
                       R.determinant());
  }
  if (has_direction && !IsUnitVector(t)) return fmt::format("t is not a unit vector: |t| = {:.9g}", t.norm());
  return std::nullopt;
}

}  // namespace

bool IsRotation(const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d deviation = R.transpose() * R - Eigen::Matrix3d::Identity();
  return R.allFinite() && deviation.cwiseAbs().maxCoeff() <= kMaxMotionRounding && R.determinant() > 0.0;
}

bool IsUnitVector(const Eigen::Vector3d& t) {
  return t.allFinite() && std::abs(t.norm() - 1.0) <= kMaxMotionRounding;
}

bool IsCovariance(const Matrix5d& covariance) {
  if (!covariance.allFinite() || covariance.diagonal().minCoeff() < 0.0) return false;
  const Vector5d sd = covariance.diagonal().cwiseSqrt();
  Matrix5d correlation = Matrix5d::Identity();
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      if (i == j) continue;
      // Every covariance has |C_ij| <= sd_i sd_j, so an exactly known coordinate has no covariances.
      const bool is_exact = sd(i) == 0.0 || sd(j) == 0.0;
      if (is_exact && covariance(i, j) != 0.0) return false;
      correlation(i, j) = is_exact ? 0.0 : covariance(i, j) / sd(i) / sd(j);
    }
  }
  if (!correlation.allFinite()) return false;
  if ((correlation - correlation.transpose()).cwiseAbs().maxCoeff() > kMaxCovarianceRounding) return false;
  // The matrix plus the tolerance is positive definite if all eigenvalues are >= -tolerance.
  correlation.diagonal().array() += kMaxCovarianceRounding;
  return Eigen::LLT<Matrix5d>(correlation).info() == Eigen::Success;
}

bool HasCovarianceOfRcme(const MotionEstimate& estimate) {
  return estimate.status == MotionStatus::kOk && estimate.message.ends_with(kCovarianceOfRcme);
}

std::optional<AnswerFault> FindFault(const MotionEstimate& estimate, size_t num_matches) {
  if (const Description fault = FaultOfAccount(estimate, num_matches))
    return AnswerFault{MotionStatus::kInvalidMotion, *fault};
  if (const Description fault = FaultOfMotion(estimate))
    return AnswerFault{MotionStatus::kInvalidMotion, *fault};
  if (estimate.status != MotionStatus::kOk || IsCovariance(estimate.pose_cov)) return std::nullopt;
  return AnswerFault{
      MotionStatus::kInvalidCovariance,
      HasCovarianceOfRcme(estimate)
          ? fmt::format("its inliers determine no covariance, and it states none ({})", kCovarianceOfRcme)
          : "the covariance is not finite, symmetric and positive semidefinite"};
}

MotionEstimate Judged(MotionEstimate estimate, size_t num_matches) {
  const std::optional<AnswerFault> fault = FindFault(estimate, num_matches);
  if (!fault) return estimate;
  if (FaultOfAccount(estimate, num_matches)) {
    MotionEstimate bare;
    bare.cam2_from_cam1 = estimate.cam2_from_cam1;
    bare.pose_cov = estimate.pose_cov;
    estimate = std::move(bare);
  }
  estimate.status = fault->status;
  estimate.message = fault->message;
  return estimate;
}

}  // namespace rcme
