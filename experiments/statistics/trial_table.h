// The raw trials as a table of text: one row per trial and estimator.
#pragma once

#include <functional>
#include <string>

#include "experiments/run/store/result_store.h"

namespace rcme {

// Hands the table to `write` as CSV, a line or more at a time, in constant memory: study, condition, one
// column per factor (its level), trial, estimator (its label), outcome (trial_outcome.h), then every column
// of the records, the status first, and of the problems (docs/result_file.md). What is not
// known is an empty field. A factor that is called as one of the other columns is written as "level_NAME".
// Wall times, which no two runs share, only if asked for. Numbers have all their digits. Throws InputError
// before the first line if a trial is not sound.
void WriteTrialTable(const ResultStore& store, bool with_times,
                     const std::function<void(const std::string&)>& write);

}  // namespace rcme
