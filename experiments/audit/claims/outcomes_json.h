// Outcomes of a check's trials and its result, as text and back, every number to its last bit.
#pragma once

#include <string>
#include <vector>

#include "experiments/audit/claims/claim_verdict.h"

namespace rcme {

// A JSON list with one entry per stored statistic, ascending: those that the check's targets and its
// difficulty use. For a rate it is a text with one character per trial, 1, 0 or n (NaN); for others it is a
// list of numbers.
std::string OutcomesAsJson(const Check& check, const std::vector<Outcome>& outcomes);

// The outcomes of `num_trials` trials; statistics that are not stored are NaN. Throws std::exception if the
// text is no such list.
std::vector<Outcome> OutcomesFrom(const Check& check, const std::string& text, size_t num_trials);

// A JSON list: trials, targets, verdict, fifths, reason why the check is not possible.
std::string CheckResultAsJson(const CheckResult& result);
// The result of that check. Throws std::exception if the text is no such list.
CheckResult CheckResultFrom(const Check& check, const std::string& text);

}  // namespace rcme
