// A quantile of independent values with a distribution-free interval.
#pragma once

#include <cstdint>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

// The ranks, counted from 1, of two of n ascending values that enclose the p-quantile of their law with at
// least `confidence`. Each end is missed with at most half of the remaining probability, whatever the law.
// `lower` is 0 and `upper` n + 1 if no value is far enough out.
struct RankInterval {
  std::int64_t lower = 0, upper = 0;
};
RankInterval QuantileRanks(std::int64_t n, double p, double confidence = 0.95);

// The p-quantile of a law from n independent values: the ceil(n p)-th smallest (the left-continuous inverse
// of the empirical distribution function).
struct MeasuredQuantile {
  double value = 0.0;
  // Half the distance between the order statistics n p +- sqrt(n p (1 - p)), rounded outwards and kept to
  // 1..n. No density is estimated and no normality assumed.
  double standard_error = 0.0;
  // Between two order statistics and distribution-free: contains the quantile with at least `confidence`,
  // each end missed with at most half of the remaining probability. An end is infinite if no order statistic
  // is far enough out.
  Interval interval;
};
// Throws std::invalid_argument if there are no values, one is NaN, or p or confidence is not in (0, 1).
MeasuredQuantile MeasureQuantile(std::vector<double> values, double p, double confidence = 0.95);

}  // namespace rcme
