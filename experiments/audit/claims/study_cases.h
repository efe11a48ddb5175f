// Cases from the conditions of a study.
#pragma once

#include <limits>

#include "experiments/audit/claims/case_claim.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// The conditions that an audit or a map takes: each costs seconds to minutes.
inline constexpr size_t kMaxCaseConditions = 1'000;

// Throws InputError for a study that cannot give cases: of pairs from match files nobody knows which matches
// are true; and for more conditions than that.
void RequireCases(const Study& study);

// All settings of a condition's simulation; of a study that can give cases.
Settings SimulatedSettings(const StudyPlan& plan, const Condition& condition);

// Cases of a condition; their severity is not measured. NotSimulated shows when one is made.
CaseMaker StudyCases(const StudyPlan& plan, const Condition& condition);

// What a case lacks for a statistic with these needs, in words; empty: nothing.
std::string WhatIsMissing(const Case& made, const CaseNeeds& needs);

// Leaves in the problem only true matches, in their order: the first `num_matches` of them.
void KeepTrueMatches(TrialData* data, size_t num_matches = std::numeric_limits<size_t>::max());

// Leaves in the problem what a statistic with these needs takes from it.
void KeepWhatIsNeeded(TrialData* data, const CaseNeeds& needs);

}  // namespace rcme
