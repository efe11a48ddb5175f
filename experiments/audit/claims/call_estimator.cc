#include "experiments/audit/claims/call_estimator.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/design.h"
#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

double CountedNees(const TrialRecord& record, const FailureBounds& bounds) {
  if (IsInvalid(record)) return kInfinity;
  if (HasRefused(record) || HasFailed(record, bounds)) return kNaN;
  return std::isfinite(record.nees) ? record.nees : kInfinity;
}

struct ScoredAnswer {
  MotionEstimate answer;  // as it was given
  TrialRecord record;
};

ScoredAnswer AskEstimator(const MotionEstimator& estimator, const Case& made) {
  RandomStream sampling_rng = StreamFor(made.name, StreamPurpose::kSampling);
  ScoredAnswer scored{estimator.Estimate(made.problem(), sampling_rng), {}};
  scored.record = Score(scored.answer, made.data, 0.0);
  return scored;
}

}  // namespace

TrialRecord CallEstimator(const MotionEstimator& estimator, const Case& made) {
  return AskEstimator(estimator, made).record;
}

Outcome CovarianceStatistic(const TrialRecord& record, const Case& made, const FailureBounds& bounds) {
  const std::optional<Matrix5d> bound = CramerRaoBound(made);
  return {CountedNees(record, bounds), HasRefused(record) ? 0.0 : 1.0, HasFailed(record, bounds) ? 1.0 : 0.0,
          IsInvalid(record) ? 1.0 : 0.0, bound ? std::sqrt(bound->trace()) * 180.0 / std::numbers::pi : kNaN};
}

Outcome ReportedCovarianceStatistic(const MotionEstimator& estimator, const Case& made,
                                    const FailureBounds& bounds) {
  return CovarianceStatistic(CallEstimator(estimator, made), made, bounds);
}

std::vector<Target> ReportedCovarianceTargets() {
  constexpr int kDegreesOfFreedom = 5;
  std::vector<Target> targets = CoverageTargets(kDegreesOfFreedom, kEstimatorTolerance);
  Target gross{fmt::format("coverage at alpha {}", kGrossErrorLevel),
               Target::Kind::kCoverage,
               1.0 - kGrossErrorLevel,
               {1.0 - kGrossErrors.margin, 1.0},
               ChiSquareQuantile(kDegreesOfFreedom, 1.0 - kGrossErrorLevel)};
  gross.degrees_of_freedom = kDegreesOfFreedom;
  targets.push_back(gross);
  targets.push_back(MeasuredRate("returns a motion", 1));
  targets.push_back(MeasuredRate("fails", 2));
  targets.push_back(MeasuredRate("answers that are not valid", 3));
  return targets;
}

double DrawShareBeyond(const MotionEstimate& answer, const FailureBounds& bounds, RandomStream& rng) {
  constexpr int kNumDraws = 16;
  const RelativePose& pose = answer.cam2_from_cam1;
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(answer.pose_cov);  // pose_cov may be singular
  const Vector5d sd = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  constexpr double kFarthest = 8.0;  // in standard deviations; beyond with probability 2e-12
  const double least_bound_deg = std::min(bounds.max_rotation_error_deg, bounds.max_direction_error_deg);
  if (kDegPerRad * kFarthest * sd.maxCoeff() < least_bound_deg) return 0.0;
  const Matrix5d root = eigen.eigenvectors() * sd.asDiagonal();
  int num_beyond = 0;
  for (int draw = 0; draw < kNumDraws; ++draw) {
    Vector5d normal;
    for (double& each : normal) each = rng.Normal();
    const RelativePose drawn = Retract(pose, root * normal);
    num_beyond += kDegPerRad * RotationAngleBetween(pose.R, drawn.R) > bounds.max_rotation_error_deg ||
                  kDegPerRad * AngleBetween(pose.t, drawn.t) > bounds.max_direction_error_deg;
  }
  return num_beyond / static_cast<double>(kNumDraws);
}

Outcome FailureStatistic(const TrialRecord& record, const ImpliedFailure& implied,
                         const FailureBounds& bounds) {
  constexpr double kSure = 0.01, kFairlySure = 0.1;
  if (HasRefused(record)) return Outcome(6, kNaN);
  const double P = record.failure_probability, y = HasFailed(record, bounds) ? 1.0 : 0.0;
  if (std::isnan(P)) return {implied.is_sure ? y - implied.share : kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  return {P <= kSure ? y - P : kNaN, P - y, (P - y) * P, P <= kFairlySure ? y : kNaN, (P - y) * (P - y), P};
}

Outcome StatedFailureStatistic(const MotionEstimator& estimator, Case& made, const FailureBounds& bounds) {
  const auto [answer, record] = AskEstimator(estimator, made);
  ImpliedFailure implied;  // share 0 for an answer without a covariance
  if (record.status == MotionStatus::kOk) {
    implied.is_sure = DrawShareBeyond(answer, bounds, made.rng) == 0.0;
    implied.share = DrawShareBeyond(answer, bounds, made.rng);
  }
  return FailureStatistic(record, implied, bounds);
}

std::vector<Target> StatedFailureTargets() {
  // Bounded means count on a grid (stats/score_mean.h). The ranges make 0, the value of most trials, a grid
  // point.
  return {PlannedBoundedMean("failures of sure answers less what they state", 0.0,
                             {-1.0, kUnstatedFailures.margin}, {-1.0, 1.0}, kUnstatedFailures),
          IfStated(PlannedBoundedMean("stated less actual rate of failures", 0.0,
                                      Around(0.0, kStatedProbability.margin), {-1.0, 1.0}, kStatedProbability,
                                      1)),
          IfStated(PlannedBoundedMean("the same, weighted by the stated probability", 0.0,
                                      Around(0.0, kWeightedProbability.margin), {-0.25, 1.0},
                                      kWeightedProbability, 2)),
          IfStated(PlannedRate("failures among answers with P <= 0.1", 0.0, kSureAnswers, 3)),
          IfStated(MeasuredMean("Brier score", 4)),
          IfStated(MeasuredMean("mean stated probability", 5))};
}

Outcome SigmaStatistic(const TrialRecord& record, double sigma_px_true) {
  const double stated = record.sigma_estimated_px, sd = record.sigma_estimated_sd_px;
  if (HasRefused(record) || IsInvalid(record) || std::isnan(stated)) return {kNaN, kNaN};
  const double error = stated - sigma_px_true;
  return {std::min(error / sigma_px_true, 1.0), std::isnan(sd) ? kNaN : std::pow(error / sd, 2.0)};
}

std::vector<Target> StatedSigmaTargets() {
  constexpr double kAlpha = 0.05;
  Target coverage{fmt::format("coverage at alpha {}", kAlpha), Target::Kind::kCoverage, 1.0 - kAlpha,
                  CoverageWithin(1, kAlpha, kStatedSigmaSdTolerance), ChiSquareQuantile(1, 1.0 - kAlpha)};
  coverage.statistic = coverage.degrees_of_freedom = 1;
  return {IfStated(PlannedBoundedMean("stated over true sigma, less 1", 0.0, Around(0.0, kStatedSigma.margin),
                                      {-1.0, 1.0}, kStatedSigma)),
          IfStated(coverage)};
}

bool FailsSilently(const TrialRecord& record) { return HasFailed(record, FailureBounds()); }

bool FailsOrRefuses(const TrialRecord& record) { return !HasSucceeded(record, FailureBounds()); }

double OnlyFirst(bool first, bool second) {
  if (first == second) return kNaN;
  return first ? 1.0 : 0.0;
}

}  // namespace rcme
