#pragma once

#include <string>
#include <vector>

#include "experiments/statistics/compare.h"
#include "experiments/statistics/forecast_measures.h"
#include "experiments/statistics/summarize.h"

namespace rcme {

// What a run shows, a sentence each, what matters most first:
//   regions that are far from the 95 % that they state (the whole interval below 90 or above 98 %)
//   each estimator against the reference on the same trials: where the tests (Holm-adjusted p below 0.05)
//   decide, those ahead first; over a population the differences with their intervals
//   stated probabilities of failure whose mean lies outside the interval of the rate of failures
//   refusals of more than a tenth of the trials
//   the range of each failure rate with the conditions at its ends
// Rates have their 95 % intervals and the digits of the tables. Nothing is said of what has no trials or no
// partner.
std::vector<std::string> ListFindings(const Summary& summary, const Comparison& comparison,
                                      const std::vector<ForecastMeasures>& forecasts);

}  // namespace rcme
