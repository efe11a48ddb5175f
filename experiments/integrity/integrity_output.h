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
  bool has_common_scenes = false;  // a number is the same scene in all conditions
  std::vector<std::string> factors;
  std::vector<ConditionIntegrity> conditions;
  bool has_real_truth = false;  // a measured one, of real pairs
};

// Whether errors are beyond their level as seldom as the risk says, by the 95 % interval of how often.
enum class RiskVerdict { kKept, kExceeded, kUndecided };
const char* Name(RiskVerdict verdict);

// What a row says of one quantity, or of either (kEither). Intervals are exact binomial ones; where trials
// depend on each other, by clusters (stats/clustered_estimate.h).
struct IntegrityRates {
  Estimate available;   // of all trials: level within the alert limit
  Estimate misleading;  // of the answers: error beyond the level
  Estimate hazardous;   // of all trials: error beyond the alert limit, level within
  RiskVerdict verdict =
      RiskVerdict::kUndecided;  // of rotation and of direction: the risk is promised for each
};
// `clusters` are independent; where each is to be taken as trials that are independent themselves,
// `by_trial`.
IntegrityRates MeasureIntegrity(const std::vector<IntegrityTally>& clusters, bool by_trial, size_t quantity,
                                double risk);

// Over all conditions, each trial with the same weight. Of a new problem from another condition, conditions
// are the clusters; otherwise scenes or trials.
IntegrityRates MeasureIntegrity(const IntegrityReport& report, size_t quantity);

// Over all conditions: exceeded in rotation or in direction, kept in both, or undecided. If the risk is kept,
// "exceeded" is said with probability at most 5 %: 2.5 % for each, as the lower end of an interval has it.
RiskVerdict JudgeRisk(const IntegrityReport& report);

std::string IntegrityAsText(const IntegrityReport& report);
std::string IntegrityAsJson(const IntegrityReport& report);

CommandResult MakeIntegrityResult(const IntegrityReport& report);

}  // namespace rcme
