// How a trial ended for one estimator: the words for it, once for every table, file and page.
#pragma once

#include <string>

#include "experiments/trial/trial.h"

namespace rcme {

// kNotScored: the truth is not known or in doubt, or the trial was not simulated.
enum class TrialOutcome { kSuccess, kFailure, kRefusal, kNotScored };

TrialOutcome ClassifyOutcome(const TrialRecord& record, const FailureBounds& bounds);

// "success", "failure", "refusal", "not_scored".
const char* Name(TrialOutcome outcome);

// The same with the reason, where there is one: the status in the place of "refusal", of "failure" where
// the answer is not valid, and of "not_scored" where there was no problem, or its truth is in doubt.
std::string OutcomeInFull(const TrialRecord& record, const FailureBounds& bounds);

}  // namespace rcme
