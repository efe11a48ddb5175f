#pragma once

#include "experiments/audit/claims/audit.h"
#include "experiments/core/table/command_result.h"

namespace rcme {

// The design of the audit, before any run. For each claimed quantity: the range that counts as nominal, the
// trials of the budget, the probability that the claim holds if everything is nominal, and the smallest
// deviation that is detected with probability 0.9. For a claim with several checks, those of the first.
CommandResult MakePlanResult(const Audit& plan);

// The result of an audit. On the screen it has one row per claim: its verdict and the number that decided it,
// with interval and n; on a study, one row per claim and condition. Files have one row per claimed or
// measured number; JSON also has the claims, conditions, targets, intervals and verdicts of
// plots/audit.py.
CommandResult MakeAuditResult(const Audit& audit);

}  // namespace rcme
