#include "experiments/commands/plan_of_cases.h"

#include <fmt/format.h>

#include "experiments/audit/claims/study_cases.h"
#include "parameters/input_error.h"

namespace rcme {

StudyPlan LoadPlanOfCases(const std::string& path, const StudyChanges& changes, PlanEstimators estimators) {
  const Study study = LoadChangedStudy(path, changes);
  try {
    RequireCases(study);  // before a folder of pairs is read
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  }
  return MakePlan(study, path, estimators);
}

}  // namespace rcme
