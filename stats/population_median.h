// The median of all numbers of the draws of a population, with the population's interval.
//
// Woodruff's (1952): where [l, u] is the interval of the population's share of numbers up to the median
// (stats/population_rate.h, weights by trials), which is p of all numbers, it is from their quantile 1/2 - (p
// - l) to their quantile 1/2 + (u - p).
#pragma once

#include <span>

#include "stats/stream_median.h"

namespace rcme {

struct PopulationMedian {
  double value = 0.0;            // NaN without numbers, as the rest
  Interval interval;             // 95 %
  Interval of_these_conditions;  // of all numbers as independent ones
  double effective_n = 0.0;      // of the share up to the median
};

PopulationMedian MeasurePopulationMedian(std::span<const StreamMedian* const> draws);

}  // namespace rcme
