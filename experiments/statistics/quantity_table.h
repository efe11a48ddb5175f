// A summary as a table with a row per condition and estimator and a column per quantity.
#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/table.h"
#include "experiments/statistics/summarize.h"

namespace rcme {

// Makes an estimate with its n if that differs from `num_trials`, and with the verdict of a coverage.
Estimate MakeEstimate(const SummaryRow& row, std::int64_t num_trials);

// Makes a table of those quantities of estimators that the summary has, in the given order. Key columns: one
// per factor, the estimator, and n (the trials of the condition).
Table MakeQuantityTable(const Summary& summary, const std::vector<std::string>& quantities);
// The same by RenderText.
std::string RenderQuantityTable(const Summary& summary, const std::vector<std::string>& quantities);
// The same for quantities of the problems, without a column of estimators.
std::string RenderProblemTable(const Summary& summary, const std::vector<std::string>& quantities);

// Throws InputError for a quantity of --quantities that the summary does not have for estimators.
void CheckAreQuantities(const Summary& summary, const std::vector<std::string>& quantities);
// Inserts the sharpness of the stated covariances after `nees_coverage`, unless the list has it:
// sd_over_crb, or rotation_sd_deg and direction_sd_deg if no bound is known. A region can have any coverage
// if it is wide enough.
std::vector<std::string> AddSharpness(const Summary& summary, std::vector<std::string> quantities);
// Removes all rows except those of these quantities of estimators. Throws as CheckAreQuantities.
void KeepQuantities(const std::vector<std::string>& quantities, Summary* summary);

}  // namespace rcme
