#pragma once

#include <string>
#include <vector>

#include "experiments/statistics/summarize.h"

namespace rcme {

// Returns the quantities of a paper's table that are used by default.
const std::vector<std::string>& DefaultLatexQuantities();

// Renders a LaTeX tabular with the rules of the package booktabs: a row per condition and estimator, a
// column per quantity. Each number has its interval or standard error, its n if that is not the row's, and a
// coverage its verdict.
// Comments before the tabular name the study, the kind of the intervals and the required packages. `labels`
// are pairs {name, text}: texts to print instead of the names of estimators, factors or quantities. All
// texts are escaped. Throws InputError for a quantity that the summary does not have, and for a label whose
// name is not in the table.
std::string SummaryAsLatex(const Summary& summary, const std::vector<std::string>& quantities,
                           const Settings& labels);

}  // namespace rcme
