// The claims about calibration on a study's own scene, cameras, motion, noise, outliers and estimators.
#pragma once

#include "experiments/audit/claims/claim.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// One claim per calibration claim (calibration.h) and per estimator of the study, each with one check per
// condition of the plan. Minimal samples take a trial's first true matches, whose order is random; maximum
// likelihood and the entropy take all true matches; an estimator takes the whole problem.
//
// If a condition cannot give a statistic, its check says why (Check::not_possible) and has no targets. A
// single trial that cannot, because it has too few true matches, counts as a trial of the check but not in a
// target's n. Throws InputError for a study that cannot give cases (study_cases.h).
std::vector<Claim> StudyClaims(const StudyPlan& plan);

}  // namespace rcme
