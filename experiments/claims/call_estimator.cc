#include "experiments/claims/call_estimator.h"

#include <cmath>
#include <numbers>

#include "experiments/claims/cramer_rao.h"
#include "experiments/claims/design.h"

namespace rcme {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double CountedNees(const TrialRecord& record, const FailureBounds& bounds) {
  if (IsInvalid(record)) return kInfinity;
  if (HasRefused(record) || HasFailed(record, bounds)) return kNaN;
  return std::isfinite(record.nees) ? record.nees : kInfinity;
}

}  // namespace

TrialRecord CallEstimator(const MotionEstimator& estimator, const Case& made) {
  RandomStream sampling_rng = StreamFor(made.name, StreamPurpose::kSampling);
  return Score(estimator.Estimate(made.problem(), sampling_rng), made.data, 0.0);
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
  std::vector<Target> targets = CoverageTargets(5);
  targets.push_back(MeasuredRate("returns a motion", 1));
  targets.push_back(MeasuredRate("fails", 2));
  targets.push_back(MeasuredRate("answers that are not valid", 3));
  return targets;
}

Outcome StatedProbabilityStatistic(const TrialRecord& record, const FailureBounds& bounds) {
  if (HasRefused(record) || std::isnan(record.failure_probability)) return Outcome(5, kNaN);
  const double P = record.failure_probability, y = HasFailed(record, bounds) ? 1.0 : 0.0;
  return {P - y, (P - y) * P, P <= 0.1 ? y : kNaN, (P - y) * (P - y), P};
}

std::vector<Target> StatedProbabilityTargets() {
  // Bounded means count in bins (stats/bounded_mean.h); the ranges are a little wider than the statistics' so
  // that 0, where most of the trials are, is the middle of a bin.
  constexpr double kBin = 2.0 / 127.0, kWeightedBin = 0.01;
  return {PlannedBoundedMean("stated less actual rate of failures", 0.0,
                             Around(0.0, kStatedProbability.margin), {-1.0, 1.0 + kBin}, kStatedProbability),
          PlannedBoundedMean("the same, weighted by the stated probability", 0.0,
                             Around(0.0, kWeightedProbability.margin),
                             {-25.5 * kWeightedBin, 102.5 * kWeightedBin}, kWeightedProbability, 1),
          PlannedRate("failures among answers with P <= 0.1", 0.0, kSureAnswers, 2),
          MeasuredMean("Brier score", 3), MeasuredMean("mean stated probability", 4)};
}

bool FailsSilently(const TrialRecord& record) { return HasFailed(record, FailureBounds()); }

bool FailsOrRefuses(const TrialRecord& record) { return !HasSucceeded(record, FailureBounds()); }

double OnlyFirst(bool first, bool second) {
  if (first == second) return kNaN;
  return first ? 1.0 : 0.0;
}

}  // namespace rcme
