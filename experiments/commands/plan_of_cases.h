#pragma once

#include <string>

#include "experiments/commands/study_source.h"

namespace rcme {

// The plan of a study file with the changes applied, checked to provide cases (audit/claims/study_cases.h).
// Throws InputError as LoadChangedStudy and RequireCases do.
StudyPlan LoadPlanOfCases(const std::string& path, const StudyChanges& changes, PlanEstimators estimators);

}  // namespace rcme
