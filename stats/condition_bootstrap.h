// The interval of any statistic in a population of conditions, by a bootstrap that draws whole conditions.
//
// A sample of m conditions is drawn again from the m that were measured, with replacement, so that what the
// trials of a condition have in common stays together (Davison & Hinkley 1997, 3.8). The standard deviation
// of the statistic over such samples, times sqrt(m / (m - 1)) for the variance that a draw from few
// conditions loses, is its standard error, and the interval is Student's with m - 1 degrees of freedom.
// Quantiles of the bootstrap, BCa's among them, cover less: at 6 conditions their tails are those of 462
// different samples, and of a statistic that chance moves one way, as the expected calibration error, they do
// not hold the truth at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {

// The statistic where condition i counts times[i] times; NaN where it is not defined.
using ConditionStatistic = std::function<double(std::span<const int> times)>;

enum class ChanceBias {
  kNone,
  // A sum of distances from 0, which chance makes greater: by b for the bootstrap's mean above the value.
  // Where all true distances are 0 the value is all bias, a sum of |e|, and the bootstrap's is one of |e +
  // e'| with e' as large, sqrt(2) times the value: b is (sqrt(2) - 1) of the bias, which so is at most (1 +
  // sqrt(2)) b. The lower end is lower by that, and not below 0.
  kUpwards
};

struct BootstrapEstimate {
  double value = 0.0;                      // with each condition once
  double bias = 0.0;                       // mean of the samples less the value
  double standard_error = 0.0;             // NaN below two conditions
  Interval interval;                       // within the range; all of it below two conditions
  int num_samples = 0, num_undefined = 0;  // the latter do not count
};

struct BootstrapOptions {
  int num_samples = 1000;
  ChanceBias chance_bias = ChanceBias::kNone;
  Interval range = {0.0, 1.0};  // of the statistic
  double confidence = 0.95;
};

// Deterministic: the same stream gives the same samples. Throws std::invalid_argument without conditions or
// below two samples.
BootstrapEstimate BootstrapOverConditions(std::size_t num_conditions, const ConditionStatistic& statistic,
                                          const BootstrapOptions& options, RandomStream& rng);

}  // namespace rcme
