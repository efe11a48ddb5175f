// The mean of a number in a population of conditions, from trials in a random sample of conditions; for rates
// see population_rate.h.
//
// With x_i the mean of condition i over n_i trials and weights a_i (sum 1): value = sum a_i x_i. Its variance
// over samples of conditions is V = m / (m - 1) sum a_i^2 (x_i - value)^2, whatever the law within a
// condition (Cochran 1977, 9A.4 for equal weights, 6.3 for weights by trials). The interval is Student's with
// M - 1 degrees of freedom, M = 1 / sum a_i^2, corrected for the skewness of the conditions' means (Hall
// 1992). Student's alone misses a mean of few failures several times too often at the small levels of
// simultaneous intervals (tests/stats/population_mean_test.cc). Measured coverage:
// results/population/README.md. It covers too little if a few extreme conditions dominate the mean.
#pragma once

#include <cstdint>
#include <span>

#include "stats/moments.h"
#include "stats/population_rate.h"

namespace rcme {

struct PopulationMean {
  double value = 0.0;           // NaN without numbers
  double standard_error = 0.0;  // sqrt V; NaN below two conditions
  Interval interval;            // of the population's mean; unbounded below two conditions
  // The interval of the mean over exactly these conditions with infinitely many trials each: variance sum
  // a_i^2 s_i^2 / n_i, Student's with Satterthwaite's (1946) degrees of freedom. Unbounded if a condition has
  // one number.
  Interval of_these_conditions;
  // The number of independent trials with the same information: with s^2 = sum a_i ((x_i - value)^2 + s_i^2),
  // s^2 / V, at most n. NaN if V = 0 or a condition has one number.
  double effective_n = 0.0;
  std::int64_t n = 0;
};

// From the numbers of each condition; conditions without numbers do not count.
PopulationMean MeasurePopulationMean(std::span<const Moments> conditions,
                                     ConditionWeights weights = ConditionWeights::kEqual,
                                     double confidence = 0.95);

}  // namespace rcme
