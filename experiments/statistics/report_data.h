#pragma once

#include <string>

namespace rcme {

// What the page of `rcme report` (plots/report.py) is made of, for one run, in a folder that exists:
//   run.json        the study in words and in full, its conditions, how many trials are done, where to look
//   summary.csv     as `rcme summarize --format csv`
//   comparison.csv  as `rcme compare --format csv` against the label `against` (empty: the study's first);
//                   absent where the study has one estimator
//   reliability.json  as `rcme reliability --format json`; absent where no estimator states probabilities
// Where the conditions are draws of a population, the summary and the comparison are pooled (--pooled).
//   marginals.csv   as `rcme marginals --format csv`; only where the conditions are draws of a population
// Throws InputError that names the result file if it is not a result file, is damaged or holds no trial.
void WriteReportData(const std::string& run, const std::string& against, const std::string& folder);

}  // namespace rcme
