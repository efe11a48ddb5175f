#include "experiments/claims/call_estimator.h"

#include <cmath>
#include <numbers>

#include "experiments/claims/cramer_rao.h"

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

bool FailsSilently(const TrialRecord& record) { return HasFailed(record, FailureBounds()); }

bool FailsOrRefuses(const TrialRecord& record) { return !HasSucceeded(record, FailureBounds()); }

double OnlyFirst(bool first, bool second) {
  if (first == second) return kNaN;
  return first ? 1.0 : 0.0;
}

}  // namespace rcme
