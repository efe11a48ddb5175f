// How a trial ended for one estimator, and the names of the outcomes for all tables, files and pages.
#pragma once

#include <string>

#include "experiments/trial/trial.h"

namespace rcme {

// kNotScored: the truth is unknown or in doubt, or the trial was not simulated.
enum class TrialOutcome { kSuccess, kFailure, kRefusal, kNotScored };

TrialOutcome ClassifyOutcome(const TrialRecord& record, const FailureBounds& bounds);

// Returns "success", "failure", "refusal" or "not_scored".
const char* Name(TrialOutcome outcome);

// Returns the status, which names the reason of a refusal, an invalid answer, or a trial without a usable
// truth. For status ok: "success", "failure" or "not_scored".
std::string OutcomeInFull(const TrialRecord& record, const FailureBounds& bounds);

}  // namespace rcme
