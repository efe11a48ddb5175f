// One trial as a small C++ program, for a debugger.
#pragma once

#include <string>

#include "experiments/study/study_plan.h"
#include "experiments/trial/trial.h"

namespace rcme {

// The source of a program that calls one estimator of the plan on the problem of the trial, with its stream
// of samples, and compares the answer with that of `result`: exit code 0 if it is the same. Numbers have all
// their bits. It is built with an installed rcme or with its source tree; how stands at its top. Throws
// InputError for an estimator that is a process, whose work no debugger of this program sees, and for a trial
// that was not simulated.
std::string TrialAsCpp(const StudyPlan& plan, const Condition& condition, const TrialResult& result,
                       size_t estimator);

}  // namespace rcme
