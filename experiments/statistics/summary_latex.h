#pragma once

#include <string>
#include <vector>

#include "experiments/statistics/summarize.h"

namespace rcme {

// What a table of a paper shows where nothing else is asked for.
const std::vector<std::string>& DefaultLatexQuantities();

// A tabular of LaTeX with the rules of the package booktabs: a row per condition and estimator, a column per
// quantity, each number with its interval or standard error, and with its n where that is not the row's. In
// comments before it: the study, the kind of the intervals, what it needs. `labels`: what to print in place
// of an estimator, a factor or a quantity, {name, text}. Every text is escaped. Throws InputError for a
// quantity that the summary has not, and for a label of a name that is not in the table.
std::string SummaryAsLatex(const Summary& summary, const std::vector<std::string>& quantities,
                           const Settings& labels);

}  // namespace rcme
