#pragma once

#include <string>
#include <vector>

#include "experiments/statistics/compare.h"
#include "experiments/statistics/forecast_measures.h"
#include "experiments/statistics/summarize.h"

namespace rcme {

// Lists the findings of a run, one sentence each, the most important first:
// - regions far from the stated 95 % (the whole coverage interval below 90 or above 98 %, of 10 answers or
//   more);
// - each estimator against the reference on the same trials: significant differences (Holm-adjusted p below
//   0.05), estimators ahead first; over a population the differences with their intervals;
// - stated failure probabilities whose mean is outside the interval of the failure rate;
// - refusals of more than a tenth of the trials;
// - the range of each failure rate, with the conditions at its ends.
// Findings over a population name the study that describes it. Rates have 95 % intervals and the digits of
// the tables. Quantities without trials, and comparisons without a partner, are left out. At most eight are
// listed, of each kind the first, and then how many more there are.
std::vector<std::string> ListFindings(const Summary& summary, const Comparison& comparison,
                                      const std::vector<ForecastMeasures>& forecasts);

}  // namespace rcme
