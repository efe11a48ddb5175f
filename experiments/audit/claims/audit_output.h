#pragma once

#include <string>

#include "experiments/audit/claims/audit.h"
#include "experiments/core/table/command_result.h"

namespace rcme {

// What was laid down before the run: of each claimed quantity the range that counts as nominal, the trials of
// the budget, the probability that the claim holds where everything is nominal, and the smallest departure
// that is found with probability 0.9. Of a claim with several checks the first.
CommandResult MakePlanResult(const Audit& plan);

// For people one row per claim: its verdict and the number that decided it, with interval and n; on a study
// one per claim and condition. In files a row per claimed or measured number; in JSON also what audit_json.h
// has.
CommandResult MakeAuditResult(const Audit& audit);

}  // namespace rcme
