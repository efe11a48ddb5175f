// A summary with a row per condition and estimator and a column per quantity.
#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/table.h"
#include "experiments/statistics/summarize.h"

namespace rcme {

// With its n where that is not `num_trials`, and a coverage with its verdict.
Estimate MakeEstimate(const SummaryRow& row, std::int64_t num_trials);

// Those of the quantities of estimators that the summary has, in their order. Key columns: a column per
// factor, the estimator, n (the trials of the condition).
Table MakeQuantityTable(const Summary& summary, const std::vector<std::string>& quantities);
// RenderText of it.
std::string RenderQuantityTable(const Summary& summary, const std::vector<std::string>& quantities);
// The same of the problems, without a column of estimators.
std::string RenderProblemTable(const Summary& summary, const std::vector<std::string>& quantities);

// Throws InputError for a quantity of --quantities that the summary does not have of its estimators.
void CheckAreQuantities(const Summary& summary, const std::vector<std::string>& quantities);
// The same with what says how sharp the stated covariances are behind `nees_coverage`, where none of them
// does: sd_over_crb, or, where no bound is known, rotation_sd_deg and direction_sd_deg. A region covers as
// often as it likes if it is wide enough.
std::vector<std::string> AddSharpness(const Summary& summary, std::vector<std::string> quantities);
// Takes away all rows but those of these quantities of estimators. Throws as CheckAreQuantities.
void KeepQuantities(const std::vector<std::string>& quantities, Summary* summary);

}  // namespace rcme
