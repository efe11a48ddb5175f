#pragma once

#include <span>
#include <vector>

#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {

// The ratio of the medians of two lists, with its interval.
struct ComparedMedians {
  double value = 0.0;  // NaN: a list is empty
  Interval interval;
};

// The values of one independent unit (image pair), of which there may be several: the observed ones, and
// those under a null hypothesis.
struct UnitValues {
  std::vector<double> observed, null;
};

inline constexpr int kLeastUnitsOfRatio = 5;

// Median of all observed values over the median of all null values. For quadratic forms it is the factor by
// which a variance is too small, robust to a few gross errors. Percentile bootstrap over units (Efron 1979),
// since the values of one unit are dependent. With fewer than kLeastUnitsOfRatio units that have observed
// values the interval is [0, infinity].
ComparedMedians RatioOfMedians(std::span<const UnitValues> units, double confidence, int num_resamples,
                               RandomStream& rng);

// The median of a list; NaN if empty.
double ComputeMedian(std::vector<double> values);

}  // namespace rcme
