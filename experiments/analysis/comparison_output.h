#pragma once

#include <string>

#include "experiments/analysis/compare.h"

namespace rcme {

// For people: a table per event, one row per condition and estimator.
std::string ComparisonAsTable(const Comparison& comparison);

// For programs: one row per condition, estimator and event, the columns study, condition, one per factor,
// estimator, reference, event, n, both, estimator_only, reference_only, neither (trials), risk_difference,
// lower, upper, p_mcnemar, p_holm. Empty cells: unknown.
std::string ComparisonAsCsv(const Comparison& comparison);

// The same rows as an object {study, reference, trials_done, trials_planned, rows: [...]}; unknown numbers
// are null.
std::string ComparisonAsJson(const Comparison& comparison);

}  // namespace rcme
