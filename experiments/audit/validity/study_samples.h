// Samples for the validity map from the conditions of a study.
#pragma once

#include "experiments/audit/validity/validity_map.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// The plan's conditions as conditions of a map: correct matches of the study's scene, cameras and motion
// under its noise law, at any noise level. The first m true matches are the sample, and the next one is
// fresh. A trial has no sample if it has fewer matches, if its motion has no direction, or if it belongs to a
// draw that cannot be simulated. An assumed sigma (assumed_sigma_px) keeps its ratio to the true one.
// Conditions that differ only in the noise level are one. Throws InputError for a study that cannot give
// cases (audit/claims/study_cases.h).
std::vector<MapCondition> ListMapConditions(const StudyPlan& plan);

// The noise levels of the study's conditions, px, ascending, without repetition.
std::vector<double> ListSigmas(const StudyPlan& plan);

}  // namespace rcme
