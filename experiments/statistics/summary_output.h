#pragma once

#include <string>

#include "experiments/core/text/write_text.h"
#include "experiments/statistics/summarize.h"

namespace rcme {

// For people: a row per condition and estimator with the main quantities, intervals and n.
std::string SummaryAsTable(const Summary& summary);
// For people: these quantities of the estimators only. Throws InputError if the summary does not have one.
std::string QuantitiesAsTable(const Summary& summary, const std::vector<std::string>& quantities);

// For programs: a row for every quantity (tidy data), with the columns study, condition, one per factor,
// estimator, quantity, kind, value, lower, upper, standard_error, n, interval (its kind), verdict and
// trials_to_decide (of nees_coverage: coverage_verdict.h). Empty cells mean unknown.
std::string SummaryAsCsv(const Summary& summary);

// The same rows as an object {study, trials_done, trials_planned, rows: [...]}. Unknown and infinite numbers
// are null.
std::string SummaryAsJson(const Summary& summary);

// The same texts piece by piece; those of ten thousand conditions have hundreds of megabytes.
void WriteSummaryCsv(const Summary& summary, const WriteText& write);
void WriteSummaryJson(const Summary& summary, const WriteText& write);

// Returns "exact 95 % (Clopper-Pearson)" and the like, for people.
std::string DescribeIntervalKind(IntervalKind kind);

// Returns the kinds of intervals of the estimators' rates: one, or several joined by "and".
std::string IntervalKindsIn(const Summary& summary);

}  // namespace rcme
