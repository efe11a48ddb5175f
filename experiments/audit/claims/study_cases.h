// Cases from the conditions of a study.
#pragma once

#include <limits>

#include "experiments/audit/claims/case.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// Throws InputError for a study that cannot give cases: one with pairs from match files, whose true matches
// are unknown, or one with more than 1,000 conditions.
void RequireCases(const Study& study);

// All settings of a condition's simulation, for a study that can give cases.
Settings SimulatedSettings(const StudyPlan& plan, const Condition& condition);

// Cases of a condition. Their severity is not measured. NotSimulated is thrown when a case is made.
CaseMaker StudyCases(const StudyPlan& plan, const Condition& condition);

// Describes what a case lacks for a statistic with these needs; empty: nothing.
std::string WhatIsMissing(const Case& made, const CaseNeeds& needs);

// Reduces the problem to its first `num_matches` true matches, in their order.
void KeepTrueMatches(TrialData* data, size_t num_matches = std::numeric_limits<size_t>::max());

// Reduces the problem to the matches that a statistic with these needs uses.
void KeepWhatIsNeeded(TrialData* data, const CaseNeeds& needs);

}  // namespace rcme
