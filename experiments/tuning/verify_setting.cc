#include "experiments/tuning/verify_setting.h"

#include <mutex>

#include "experiments/base/for_each_index.h"
#include "experiments/trial/trial.h"

namespace rcme {
namespace {

void AddTrial(const std::vector<TrialRecord>& records, const FailureBounds& bounds,
              std::vector<VerifiedEstimator>* verified) {
  const auto is_bad = [&](const TrialRecord& r) { return HasRefused(r) || HasFailed(r, bounds); };
  for (size_t e = 0; e < records.size(); ++e) {
    VerifiedEstimator& of = (*verified)[e];
    for (ErrorCount* count : {&of.failure, &of.refusal, &of.failure_or_refusal}) ++count->n;
    of.failure.errors += HasFailed(records[e], bounds);
    of.refusal.errors += HasRefused(records[e]);
    of.failure_or_refusal.errors += is_bad(records[e]);
    of.against_first.Add(is_bad(records[0]), is_bad(records[e]));
  }
}

}  // namespace

std::vector<VerifiedEstimator> VerifyEstimators(const StudyPlan& plan, TrialRange trials, int num_threads,
                                                Progress* progress) {
  std::vector<VerifiedEstimator> verified;
  for (const EstimatorSpec& spec : plan.study.estimators) verified.push_back({spec, {}, {}, {}, {}});
  const auto per_condition = static_cast<std::int64_t>(trials.end - trials.first);
  const std::int64_t num_trials = per_condition * static_cast<std::int64_t>(plan.conditions.size());
  std::mutex mutex;  // of `verified`; sums do not depend on the order of the trials
  ForEachIndex(num_trials, num_threads, [&](std::int64_t index) {
    const Condition& condition = plan.conditions[static_cast<size_t>(index / per_condition)];
    const auto trial = trials.first + static_cast<std::uint32_t>(index % per_condition);
    const std::vector<TrialRecord> records = RunTrial(plan, condition, trial).records;
    const std::lock_guard lock(mutex);
    AddTrial(records, plan.study.failure, &verified);
    progress->Advance(1);
  });
  return verified;
}

}  // namespace rcme
