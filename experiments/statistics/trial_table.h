// The raw trials as a text table: a row per trial and estimator.
#pragma once

#include <functional>
#include <string>

#include "experiments/run/store/result_store.h"

namespace rcme {

// Passes the table to `write` as CSV, one or more lines at a time, in constant memory. The columns are
// study, condition, one per factor (its level), trial, estimator (its label), outcome (trial_event.h),
// then every column of the records, beginning with the status, and of the problems (docs/result_file.md).
// Unknown values are empty. A factor whose name is also that of another column is called "level_NAME".
// Times, which differ in every run, are included only if requested. Numbers have all their digits. Throws
// InputError before the first line if a trial is damaged.
void WriteTrialTable(const ResultStore& store, bool with_times,
                     const std::function<void(const std::string&)>& write);

}  // namespace rcme
