#include "estimator/problem_check.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "estimator/noise_scale.h"

namespace rcme {
namespace {

// The number of distinct matches; counting stops at `enough`.
int CountDistinct(const std::vector<Correspondence>& matches, int enough) {
  std::vector<const Correspondence*> distinct;
  for (const Correspondence& match : matches) {
    if (static_cast<int>(distinct.size()) == enough) break;
    const bool is_new = std::none_of(distinct.begin(), distinct.end(), [&](const Correspondence* other) {
      return other->x1_px == match.x1_px && other->x2_px == match.x2_px;
    });
    if (is_new) distinct.push_back(&match);
  }
  return static_cast<int>(distinct.size());
}

// Root mean square distance (px) of the points of one image from their best line.
double RmsDistanceFromLine(const std::vector<Correspondence>& matches,
                           Eigen::Vector2d Correspondence::*point) {
  const double n = static_cast<double>(matches.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Correspondence& match : matches) mean += match.*point;
  mean /= n;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Correspondence& match : matches) {
    const Eigen::Vector2d offset = match.*point - mean;
    scatter += offset * offset.transpose();
  }
  scatter /= n;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(scatter, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(eigen.eigenvalues()(0), 0.0));
}

std::optional<MotionEstimate> RefuseNoiseScale(const MotionProblem& problem) {
  const std::vector<double>& scales = problem.noise_scale;
  if (scales.empty()) return std::nullopt;
  if (scales.size() != problem.matches.size()) {
    return MakeRefusal(
        MotionStatus::kInvalidInput,
        fmt::format("noise_scale has {} entries for {} matches; one for each, or none, is allowed",
                    scales.size(), problem.matches.size()));
  }
  for (size_t i = 0; i < scales.size(); ++i) {
    if (scales[i] >= 1.0 / kMaxNoiseScale && scales[i] <= kMaxNoiseScale) continue;
    return MakeRefusal(MotionStatus::kInvalidInput,
                       fmt::format("the noise_scale of match {} is {}; a number in [{:g}, {:g}] is allowed",
                                   i, scales[i], 1.0 / kMaxNoiseScale, kMaxNoiseScale));
  }
  return std::nullopt;
}

std::optional<MotionEstimate> RefuseMatchQuality(const MotionProblem& problem) {
  const std::vector<double>& qualities = problem.match_quality;
  if (qualities.empty()) return std::nullopt;
  if (qualities.size() != problem.matches.size()) {
    return MakeRefusal(
        MotionStatus::kInvalidInput,
        fmt::format("match_quality has {} entries for {} matches; one for each, or none, is allowed",
                    qualities.size(), problem.matches.size()));
  }
  for (size_t i = 0; i < qualities.size(); ++i) {
    if (std::isfinite(qualities[i])) continue;
    return MakeRefusal(
        MotionStatus::kInvalidInput,
        fmt::format("the match_quality of match {} is {}; a finite number is allowed", i, qualities[i]));
  }
  return std::nullopt;
}

}  // namespace

std::optional<MotionEstimate> RefuseUnsolvable(const MotionProblem& problem, int min_matches) {
  if (!problem.camera1.IsValid() || !problem.camera2.IsValid()) {
    return MakeRefusal(MotionStatus::kInvalidInput,
                       "a camera matrix K is not finite or not invertible, or an image size is not positive");
  }
  if (!(problem.sigma_px > 0.0) || !std::isfinite(problem.sigma_px)) {
    return MakeRefusal(MotionStatus::kInvalidInput,
                       fmt::format("sigma_px is {}; it must be > 0", problem.sigma_px));
  }
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    const Correspondence& match = problem.matches[i];
    const double largest = std::max(match.x1_px.cwiseAbs().maxCoeff(), match.x2_px.cwiseAbs().maxCoeff());
    if (!match.x1_px.allFinite() || !match.x2_px.allFinite() || largest > kMaxCoordinatePx) {
      return MakeRefusal(MotionStatus::kInvalidInput,
                         fmt::format("match {} has a coordinate that is not a finite pixel position", i));
    }
  }
  if (std::optional<MotionEstimate> refusal = RefuseNoiseScale(problem)) return refusal;
  if (std::optional<MotionEstimate> refusal = RefuseMatchQuality(problem)) return refusal;
  if (const std::string fault = problem.prior ? FindPriorFault(*problem.prior) : ""; !fault.empty())
    return MakeRefusal(MotionStatus::kInvalidInput, fault);
  const int num_distinct = CountDistinct(problem.matches, min_matches);
  if (num_distinct < min_matches) {
    return MakeRefusal(MotionStatus::kTooFewMatches,
                       fmt::format("{} distinct matches of {}; at least {} are needed", num_distinct,
                                   problem.matches.size(), min_matches));
  }
  for (const auto& [point, image] : {std::pair{&Correspondence::x1_px, 1}, {&Correspondence::x2_px, 2}}) {
    const double rms = RmsDistanceFromLine(problem.matches, point);
    if (rms > 2.0 * problem.sigma_px) continue;
    return MakeRefusal(
        MotionStatus::kDegenerateMatches,
        fmt::format("all points of image {} lie on one line within the noise ({:.2g} px rms from it): they "
                    "do not determine a motion",
                    image, rms));
  }
  return std::nullopt;
}

}  // namespace rcme
