// Integrity counts of one estimator over the trials of a study, as work for the runner (core/work/runner.h).
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "experiments/core/work/runner.h"
#include "experiments/integrity/integrity_counts.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// `plan` has one estimator.
WorkPlan PlanIntegrity(const StudyPlan& plan, const IntegrityTerms& terms);
void GetIntegrity(const StudyPlan& plan, const IntegrityTerms& terms, Runner* runner);

struct ConditionIntegrity {
  std::vector<std::string> levels;
  // Conditions of one draw of a population, or of one real scene, have the same number; with
  // NewProblem::kCondition (trial_grouping.h) they depend on each other.
  std::int64_t group = 0;
  IntegrityCounts counts;
  // By scene number; empty if every trial has its own scene. Trials of a scene depend on each other, also
  // across conditions if the study has common scenes.
  std::map<std::int64_t, IntegrityTally> scenes;
};
// Returns one entry per condition of the plan, in its order.
std::vector<ConditionIntegrity> ReadIntegrity(const StudyPlan& plan, const Runner& runner);

}  // namespace rcme
