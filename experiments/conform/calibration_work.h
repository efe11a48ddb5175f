// The answers of one estimator to the problems of a study, as work for the runner (core/work/runner.h).
#pragma once

#include "experiments/conform/answer_row.h"
#include "experiments/core/work/runner.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_grouping.h"
#include "experiments/trial/trial_items.h"

namespace rcme {

// `plan` has one estimator.
WorkPlan PlanCalibration(const StudyPlan& plan);
void GetCalibration(const StudyPlan& plan, Runner* runner);
// In the order of conditions and trials. Of one group are at least the trials of one scene, of one real pair
// (it comes again in each pass over a folder), and, where conditions are new, of one draw or real scene. A
// truth that has an error of its own is taken as it is. Throws InputError where conditions share their scenes
// and are to be new.
AnswerRows ReadCalibration(const StudyPlan& plan, NewProblem new_problem, const Runner& runner);

}  // namespace rcme
