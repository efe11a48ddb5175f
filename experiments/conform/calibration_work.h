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
// Returns the answers in the order of conditions and trials. Trials are in one group if they have the same
// scene or the same real pair, which comes again in each pass over a folder. With NewProblem::kCondition
// trials of the same draw or real scene are in one group too. A truth with an error of its own is taken as
// exact. Throws InputError for NewProblem::kCondition if conditions share their scenes.
AnswerRows ReadCalibration(const StudyPlan& plan, NewProblem new_problem, const Runner& runner);

}  // namespace rcme
