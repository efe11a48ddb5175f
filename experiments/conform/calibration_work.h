// The answers of one estimator to the problems of a study, as work for the runner (core/work/runner.h).
#pragma once

#include "experiments/conform/answer_row.h"
#include "experiments/core/work/runner.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// What a new problem is, and so what is independent.
enum class NewProblem {
  kTrial,      // another trial of these conditions
  kCondition,  // a trial of another condition: drawn as these were, or of another real scene
};

// Of a population of conditions, and of real scenes: another one; otherwise another trial.
NewProblem UsualNewProblem(const StudyPlan& plan);

// `plan` has one estimator.
WorkPlan PlanCalibration(const StudyPlan& plan);
void GetCalibration(const StudyPlan& plan, Runner* runner);
// In the order of conditions and trials. Trials of one scene are of one group at least. The trials of a given
// truth that has its own error are judged by that truth as it is.
AnswerRows ReadCalibration(const StudyPlan& plan, NewProblem new_problem, const Runner& runner);

}  // namespace rcme
