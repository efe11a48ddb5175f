// Cases from the conditions of a study.
#pragma once

#include <limits>

#include "experiments/claims/case_claim.h"
#include "experiments/study_plan.h"

namespace rcme {

// All settings of a condition's simulation. Throws InputError for pairs from match files.
Settings SimulatedSettings(const StudyPlan& plan, const Condition& condition);

// Cases of a condition; their severity is not measured. Throws as SimulatedSettings.
CaseMaker StudyCases(const StudyPlan& plan, const Condition& condition);

// What a case lacks for a statistic with these needs, in words; empty: nothing.
std::string WhatIsMissing(const Case& made, const CaseNeeds& needs);

// Leaves in the problem only true matches, in their order: the first `num_matches` of them.
void KeepTrueMatches(TrialData* data, size_t num_matches = std::numeric_limits<size_t>::max());

// Leaves in the problem what a statistic with these needs takes from it.
void KeepWhatIsNeeded(TrialData* data, const CaseNeeds& needs);

}  // namespace rcme
