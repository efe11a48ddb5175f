// Outcomes of a check's trials, and what they say of it, as text and back, every number to its last bit.
#pragma once

#include <string>
#include <vector>

#include "experiments/audit/claims/claim_verdict.h"

namespace rcme {

// The statistics that the check's targets and its difficulty are of, ascending: what is kept of an outcome.
std::vector<size_t> ListStatistics(const Check& check);

// A JSON list with one entry for each of these statistics: of a rate's trials a text with a character for
// each, 1, 0 or n (NaN), of others a list of their numbers.
std::string OutcomesAsJson(const Check& check, const std::vector<Outcome>& outcomes);

// Of `num_trials` trials; other statistics are NaN. Throws std::exception for what is no such list.
std::vector<Outcome> OutcomesFrom(const Check& check, const std::string& text, size_t num_trials);

// A JSON list: trials, targets, verdict, fifths, why it is not possible.
std::string CheckResultAsJson(const CheckResult& result);
// Of that check. Throws std::exception for what is no such list.
CheckResult CheckResultFrom(const Check& check, const std::string& text);

}  // namespace rcme
