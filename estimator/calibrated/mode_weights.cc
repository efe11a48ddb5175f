#include "estimator/calibrated/mode_weights.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/calibrated/fitted_constants.h"
#include "stats/eigen_solvers.h"

namespace rcme {
namespace {

constexpr double kLeastSharedVariance = 10.0;
constexpr double kAxial = 0.95;         // least forwardness of travel along the axis
constexpr double kTurnRad = 0.05;       // below it, smaller rotations are hardly more likely
constexpr double kFewExplained = 10.0;  // the width of modes of many more matches counts less

double SignedRoot(double x) { return std::copysign(std::sqrt(std::abs(x)), x); }

double Axial(double forwardness) { return std::max(forwardness - kAxial, 0.0) / (1.0 - kAxial); }

}  // namespace

const std::array<const char*, kNumModeTerms> kModeTermNames = {"exclusive", "shared",  "explained", "noise",
                                                               "width",     "forward", "axial",     "turn"};

double ComputeForwardness(const RelativePose& pose) {
  const double z1 = pose.R.col(2).dot(pose.t), z2 = pose.t.z();  // R' t and t: the baseline in either frame
  return 0.5 * std::abs(z1 + z2);
}

std::array<double, kNumModeTerms> ComputeModeTerms(const Contrast& contrast, const ModeTraits& a,
                                                   const ModeTraits& b) {
  const double sd = std::sqrt(contrast.shared_variance + kLeastSharedVariance);
  const double explained = std::max(a.num_explained, 1) / static_cast<double>(std::max(b.num_explained, 1));
  const double mean_explained = 0.5 * (a.num_explained + b.num_explained);
  return {SignedRoot(contrast.exclusive),
          contrast.shared / sd,
          std::log(explained),
          std::log(a.scale / b.scale),
          SignedRoot((b.log_det - a.log_det) / (1.0 + mean_explained / kFewExplained)),
          a.forwardness - b.forwardness,
          Axial(a.forwardness) - Axial(b.forwardness),
          std::log((a.turn_rad + kTurnRad) / (b.turn_rad + kTurnRad))};
}

double ModeLogOdds(const Contrast& contrast, const ModeTraits& a, const ModeTraits& b) {
  static_assert(std::size(kModeTerms) == kNumModeTerms);
  const std::array<double, kNumModeTerms> terms = ComputeModeTerms(contrast, a, b);
  double log_odds = 0.0;
  for (size_t k = 0; k < kNumModeTerms; ++k) log_odds += kModeTerms[k].weight * terms[k];
  return log_odds;
}

double EvidenceOfMotion(const Explanation& mode, const MixtureParameters& mixture, double background) {
  double evidence = -kSearchNats;
  const double w = mixture.inlier_ratio;
  for (size_t i = 0; i < mode.left_out_density.size(); ++i)
    evidence += std::log(w * mode.left_out_density[i] / WrongDensity(mode, i, background) + (1.0 - w));
  return evidence;
}

Matrix5d FindMatchInformation(const MotionPrior* prior, const Mode& mode) {
  if (prior == nullptr) return mode.hessian;
  const Matrix5d of_matches = mode.hessian - EvaluatePrior(*prior, mode.pose).hessian;
  if (Eigen::LLT<Matrix5d>(of_matches).info() == Eigen::Success) return of_matches;
  // The difference of nearly equal matrices may be indefinite. A direction that the prior alone determines
  // gets a small positive information.
  constexpr double kLeastShare = 1e-9;
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(of_matches);
  const double least = kLeastShare * mode.hessian.trace();
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(least).asDiagonal() *
         eigen.eigenvectors().transpose();
}

namespace {

// The log density of the measurements over the greatest of their stated law, at this cost.
double LogMeasurementDensity(const MotionPrior& prior, double cost) {
  constexpr double kShareBad = 0.05, kFactorBad = 5.0;
  const double bad_cost = cost / (kFactorBad * kFactorBad);
  const double bad_density = kShareBad / std::pow(kFactorBad, CountPriorFreedom(prior));
  return std::log((1.0 - kShareBad) * std::exp(bad_cost - cost) + bad_density) - bad_cost;
}

}  // namespace

double ComputePriorEvidence(const MotionPrior& prior, const Mode& mode) {
  const Eigen::LLT<Matrix5d> of_matches(FindMatchInformation(&prior, mode)), of_both(mode.hessian);
  const auto half_log_det = [](const Eigen::LLT<Matrix5d>& llt) {
    return llt.matrixLLT().diagonal().array().log().sum();
  };
  const double evidence =
      LogPeakOverUniform(prior) + LogMeasurementDensity(prior, EvaluatePrior(prior, mode.pose).cost);
  if (of_matches.info() != Eigen::Success || of_both.info() != Eigen::Success) return evidence;
  return evidence - (half_log_det(of_both) - half_log_det(of_matches));
}

bool IsSecondMotion(const Contrast& contrast) {
  constexpr int kLeast = kLeastOfSecondMotion;
  return contrast.num_clearly_a >= kLeast && contrast.num_clearly_b >= kLeast;
}

const std::array<const char*, kNumSecondMotionTerms> kSecondMotionTermNames = {"number", "extent"};

std::array<double, kNumSecondMotionTerms> ComputeSecondMotionTerms(const MotionSupport& a,
                                                                   const MotionSupport& b) {
  constexpr double kMostLogExtent = 1.5;
  const double number = static_cast<double>(std::max(a.num_better, 1)) / std::max(b.num_better, 1);
  const bool is_known = a.extent > 0.0 && b.extent > 0.0;
  const double log_extent = is_known ? std::log(a.extent / b.extent) : 0.0;
  return {std::log(number), std::clamp(log_extent, -kMostLogExtent, kMostLogExtent)};
}

double SecondMotionLogOdds(double odds, const MotionSupport& answer, const MotionSupport& second) {
  static_assert(std::size(kSecondMotionTerms) == kNumSecondMotionTerms);
  if (!(odds > 0.0) || second.num_better == 0) return -std::numeric_limits<double>::infinity();
  const std::array<double, kNumSecondMotionTerms> terms = ComputeSecondMotionTerms(second, answer);
  double log_odds = std::log(odds);
  for (size_t k = 0; k < kNumSecondMotionTerms; ++k) log_odds += kSecondMotionTerms[k].weight * terms[k];
  return log_odds;
}

}  // namespace rcme
