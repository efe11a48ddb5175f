// Measures the tuned estimator and those of the study on trials that played no part in tuning: by plain
// calls, on the same problems for all.
#pragma once

#include <vector>

#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_range.h"
#include "stats/paired.h"
#include "stats/risk_control.h"

namespace rcme {

struct VerifiedEstimator {
  EstimatorSpec spec;
  ErrorCount failure, refusal, failure_or_refusal;
  // Number of trials in which failure or refusal happened to the first estimator (first) and to this one
  // (second).
  PairedCounts against_first;
};

// Measures every estimator of the plan in these trials of every condition, in the plan's order.
std::vector<VerifiedEstimator> VerifyEstimators(const StudyPlan& plan, TrialRange trials);

}  // namespace rcme
