#include "experiments/tuning/verify_setting.h"

#include "experiments/run/for_each_trial.h"
#include "experiments/trial/trial.h"

namespace rcme {
namespace {

void AddTrial(const std::vector<TrialRecord>& records, const FailureBounds& bounds,
              std::vector<VerifiedEstimator>* verified) {
  std::vector<bool> is_bad;
  for (const TrialRecord& record : records) is_bad.push_back(HasFailedOrRefused(record, bounds));
  for (size_t e = 0; e < records.size(); ++e) {
    VerifiedEstimator& counts = (*verified)[e];
    for (ErrorCount* count : {&counts.failure, &counts.refusal, &counts.failure_or_refusal}) ++count->n;
    counts.failure.errors += HasFailed(records[e], bounds);
    counts.refusal.errors += HasRefused(records[e]);
    counts.failure_or_refusal.errors += is_bad[e];
    counts.against_first.Add(is_bad[0], is_bad[e]);
  }
}

}  // namespace

std::vector<VerifiedEstimator> VerifyEstimators(const StudyPlan& plan, TrialRange trials) {
  std::vector<VerifiedEstimator> verified;
  for (const EstimatorSpec& spec : plan.study.estimators) verified.push_back({spec, {}, {}, {}, {}});
  ForEachTrial(plan, trials, [&](const Condition& condition, std::uint32_t trial, std::int64_t) {
    const TrialResult result = RunTrialOfDraw(plan, condition, trial);
    if (result.why_not_simulated.empty()) AddTrial(result.records, plan.study.failure, &verified);
  });
  return verified;
}

}  // namespace rcme
