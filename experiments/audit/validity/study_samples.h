// Samples for the validity map from the conditions of a study.
#pragma once

#include "experiments/audit/validity/validity_map.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// The plan's conditions as those of a map: correct matches of the study's own scene, cameras and motion under
// its noise law, at any noise level. The first m true matches are the sample, the next one is fresh; a trial
// with fewer, whose motion has no direction, or that is a draw's and cannot be simulated, has no sample. An
// assumed sigma (assumed_sigma_px) keeps its ratio to the true one. Conditions that differ in the noise level
// alone are one. Throws InputError for a study that cannot give cases (audit/claims/study_cases.h).
std::vector<MapCondition> ListMapConditions(const StudyPlan& plan);

// The noise levels of the study's conditions, px, rising and each once.
std::vector<double> ListSigmas(const StudyPlan& plan);

}  // namespace rcme
