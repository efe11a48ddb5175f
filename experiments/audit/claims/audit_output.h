// The audit for people and for programs.
#pragma once

#include <string>

#include "experiments/audit/claims/audit.h"
#include "experiments/core/table/command_result.h"

namespace rcme {

// What was laid down before the run: of each claimed quantity the range that counts as nominal, the trials of
// the budget, the probability that the claim holds where everything is nominal, and the smallest departure
// that is found with probability 0.9. Of a claim with several checks the first.
CommandResult MakePlanResult(const Audit& plan);

// One row per claim: its verdict and the number that decided it, with interval and n; on a study one per
// claim and condition.
std::string AuditAsTable(const Audit& audit);

// Everything: claims, conditions, targets, intervals, verdicts. plots/audit.py draws it. Unknown or unbounded
// numbers are null.
std::string AuditAsJson(const Audit& audit);

// The audit as a page: verdict table, and per family its figure, the sentences and every measured number.
std::string AuditAsMarkdown(const Audit& audit);

CommandResult MakeAuditResult(const Audit& audit);

}  // namespace rcme
