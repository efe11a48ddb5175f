#pragma once

#include <string>

namespace rcme {

// Writes the files for the page of `rcme report` (plots/report.py), for one run, into an existing folder:
//   run.json          the study's description and text, its conditions, the number of trials done, and
//                     trials worth a look
//   summary.csv       as `rcme summarize --format csv`
//   comparison.csv    as `rcme compare --format csv` against the label `against` (empty: the study's first);
//                     absent if the study has one estimator
//   reliability.json  as `rcme reliability --format json`; absent if no estimator states probabilities
//   marginals.csv     as `rcme marginals --format csv`; only if the conditions are draws of a population
// If the conditions are draws of a population, summary and comparison are pooled (--pooled). Throws
// InputError that names the result file if it is no result file, is damaged or has no trial.
void WriteReportData(const std::string& run, const std::string& against, const std::string& folder);

}  // namespace rcme
