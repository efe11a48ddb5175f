#include "experiments/claims/call_estimator.h"

namespace rcme {

TrialRecord CallEstimator(const MotionEstimator& estimator, const Case& made) {
  RandomStream sampling_rng = StreamFor(made.name, StreamPurpose::kSampling);
  return Score(estimator.Estimate(made.problem(), sampling_rng), made.data, 0.0);
}

Outcome ReportedCovarianceStatistic(const MotionEstimator& estimator, const Case& made,
                                    const FailureBounds& bounds) {
  const TrialRecord record = CallEstimator(estimator, made);
  const bool is_returned = !HasRefused(record);  // an answer that is not valid is one: its NEES is infinite
  return {is_returned ? record.nees : std::numeric_limits<double>::quiet_NaN(), is_returned ? 1.0 : 0.0,
          HasFailed(record, bounds) ? 1.0 : 0.0};
}

bool FailsSilently(const TrialRecord& record) { return HasFailed(record, FailureBounds()); }

bool FailsOrRefuses(const TrialRecord& record) { return !HasSucceeded(record, FailureBounds()); }

double OnlyFirst(bool first, bool second) {
  if (first == second) return std::numeric_limits<double>::quiet_NaN();
  return first ? 1.0 : 0.0;
}

}  // namespace rcme
