#pragma once

#include <span>
#include <vector>

#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {

// One number that two lists of numbers are compared by, with its interval.
struct ComparedMedians {
  double value = 0.0;  // NaN: a list is empty
  Interval interval;
};

// The values of independent units (image pairs), each of which may give several: those that are observed, and
// those that a null hypothesis gives for the same unit.
struct UnitValues {
  std::vector<double> observed, null;
};

// Median of all observed values over the median of all null values. Where the values are quadratic forms, it
// is by what a variance is too small, whatever a few gross ones are. Percentile bootstrap over units (Efron
// 1979), since the values of one are not independent; of fewer than five units with values the interval is
// [0, infinity].
ComparedMedians RatioOfMedians(std::span<const UnitValues> units, double confidence, int num_resamples,
                               RandomStream& rng);

// The middle of a list, NaN of an empty one.
double ComputeMedian(std::vector<double> values);

}  // namespace rcme
