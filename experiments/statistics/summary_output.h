#pragma once

#include <string>

#include "experiments/core/text/write_text.h"
#include "experiments/statistics/summarize.h"

namespace rcme {

// For people: one row per condition and estimator with the main quantities, intervals and n.
std::string SummaryAsTable(const Summary& summary);
// For people: these quantities of the estimators alone. Throws InputError for one that the summary does not
// have.
std::string QuantitiesAsTable(const Summary& summary, const std::vector<std::string>& quantities);

// For programs: every quantity in a row of its own (tidy), the columns study, condition, one per factor,
// estimator, quantity, kind, value, lower, upper, standard_error, n, interval (its kind), verdict and
// trials_to_decide (of nees_coverage: coverage_verdict.h). Empty cells: unknown.
std::string SummaryAsCsv(const Summary& summary);

// The same rows as an object {study, trials_done, trials_planned, rows: [...]}; unknown and infinite
// numbers are null.
std::string SummaryAsJson(const Summary& summary);

// The same texts piece by piece: those of ten thousand conditions have hundreds of megabytes.
void WriteSummaryCsv(const Summary& summary, const WriteText& write);
void WriteSummaryJson(const Summary& summary, const WriteText& write);

// "exact 95 % (Clopper-Pearson)", for people.
std::string DescribeIntervalKind(IntervalKind kind);

// Of the rates of the estimators: one kind, or several joined by "and".
std::string IntervalKindsIn(const Summary& summary);

}  // namespace rcme
