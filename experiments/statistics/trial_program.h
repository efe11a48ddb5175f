// Writes one trial as a small C++ program, for a debugger.
#pragma once

#include <string>

#include "experiments/study/study_plan.h"
#include "experiments/trial/trial.h"

namespace rcme {

// Returns the source of a program that calls one estimator of the plan on the problem of the trial, with its
// stream of samples, and compares the answer with that in `result`. The exit code is 0 if they are equal.
// Numbers have all their bits. The program is built with an installed rcme or with its source tree; its
// first lines say how. Throws InputError for an estimator that is a process, whose work a debugger of this
// program cannot see, and for a trial that was not simulated.
std::string TrialAsCpp(const StudyPlan& plan, const Condition& condition, const TrialResult& result,
                       size_t estimator);

}  // namespace rcme
