#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/core/table/table.h"
#include "experiments/integrity/integrity_work.h"
#include "experiments/trial/trial_grouping.h"

namespace rcme {

struct IntegrityReport {
  std::string study, estimator;
  IntegrityTerms terms;
  NewProblem new_problem = NewProblem::kTrial;
  bool has_common_scenes = false;  // a scene number means the same scene in all conditions
  std::vector<std::string> factors;
  std::vector<ConditionIntegrity> conditions;
  bool has_real_truth = false;  // real pairs, whose truth is measured
};

// Whether P(error > level) is at most the risk, by the 95 % interval of the misleading rate.
enum class RiskVerdict { kKept, kExceeded, kUndecided };
const char* Name(RiskVerdict verdict);

// The rates of one quantity, or of kEither. Intervals are exact binomial ones, or by clusters if trials
// depend on each other (stats/clustered_estimate.h).
struct IntegrityRates {
  Estimate available;   // share of all trials: level <= alert limit
  Estimate misleading;  // share of the answers: error > level
  Estimate hazardous;   // share of all trials: level <= alert limit < error
  RiskVerdict verdict =
      RiskVerdict::kUndecided;  // for rotation or direction only: the risk is promised for each
};
// `clusters` are independent of each other. `by_trial`: so are the trials within each.
IntegrityRates MeasureIntegrity(const std::vector<IntegrityTally>& clusters, bool by_trial, size_t quantity,
                                double risk);

// Over all conditions, each trial with the same weight. The clusters are draws of the population or
// real scenes with NewProblem::kCondition, otherwise scenes or trials.
IntegrityRates MeasureIntegrity(const IntegrityReport& report, size_t quantity);

// The verdict over all conditions: exceeded in rotation or in direction, kept in both, or undecided. If the
// risk is kept in truth, the verdict is kExceeded with probability at most 5 %: 2.5 % for each quantity, by
// the lower end of its interval.
RiskVerdict JudgeRisk(const IntegrityReport& report);

std::string IntegrityAsText(const IntegrityReport& report);
std::string IntegrityAsJson(const IntegrityReport& report);

CommandResult MakeIntegrityResult(const IntegrityReport& report);

}  // namespace rcme
