#pragma once

#include <string>

#include "experiments/commands/study_source.h"

namespace rcme {

// The plan of the study of a YAML file, changed, that can give cases (audit/claims/study_cases.h). Throws
// InputError as LoadChangedStudy and RequireCases.
StudyPlan LoadPlanOfCases(const std::string& path, const StudyChanges& changes, PlanEstimators estimators);

}  // namespace rcme
