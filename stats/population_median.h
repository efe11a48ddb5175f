// The median of all numbers of the draws of a population, with the interval for the population.
//
// By Woodruff (1952): let p be the share of all numbers up to the sample's median, and [l, u] the interval of
// the population's share F up to it (stats/population_rate.h, weights by trials). At the population's median
// the sample's share is about 1/2 + p - F. The interval is therefore from the quantile 1/2 - (u - p) to the
// quantile 1/2 + (p - l) of the numbers.
#pragma once

#include <span>

#include "stats/stream_median.h"

namespace rcme {

struct PopulationMedian {
  double value = 0.0;            // NaN without numbers, like the rest
  Interval interval;             // 95 %
  Interval of_these_conditions;  // treats all numbers as independent
  double effective_n = 0.0;      // for the share of numbers up to the median
};

PopulationMedian MeasurePopulationMedian(std::span<const StreamMedian* const> draws);

}  // namespace rcme
