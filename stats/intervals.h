#pragma once

#include <cstdint>

#include "stats/moments.h"

namespace rcme {

struct Interval {
  double lower = 0.0, upper = 0.0;
  bool Contains(double x) const { return x >= lower && x <= upper; }
};

// Exact (Clopper-Pearson 1934) two-sided interval of a binomial probability from `successes` of `n`; [0, 1]
// at n = 0. Covers at least `confidence` for every true probability.
Interval ExactBinomialInterval(std::int64_t successes, std::int64_t n, double confidence = 0.95);

// The interval of the mean of independent normal numbers: mean +- t_(n-1) s / sqrt(n). Unbounded below two
// numbers.
Interval StudentInterval(const Moments& moments, double confidence = 0.95);

}  // namespace rcme
