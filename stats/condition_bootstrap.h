// The interval of any statistic in a population of conditions, by a bootstrap over whole conditions.
//
// A bootstrap sample draws m conditions with replacement from the m measured ones, so trials of one condition
// stay together (Davison & Hinkley 1997, 3.8). The standard error is the standard deviation of the statistic
// over such samples, its variance times m / (m - 1) to correct for the loss from few conditions. The interval
// is Student's with m - 1 degrees of freedom. Bootstrap quantiles, BCa included, cover less: 6 conditions
// have only 462 different samples, too few for their tails. For a statistic that chance moves in one
// direction, such as the expected calibration error, they do not contain the truth at all.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {

// The statistic if condition i counts times[i] times; NaN if undefined: such samples are left out.
using ConditionStatistic = std::function<double(std::span<const int> times)>;

enum class ChanceBias {
  kNone,
  // For a sum of distances from 0, which chance increases. Let b be the mean of the bootstrap minus the
  // value. If all true distances are 0, the value is pure bias, a sum of |e|. The bootstrap's is one of |e +
  // e'| with e' equally large, sqrt(2) times the value, so b is (sqrt(2) - 1) of the bias. The bias is
  // therefore at most (1 + sqrt(2)) b; the lower end is reduced by that, but not below the range.
  kUpwards
};

struct BootstrapEstimate {
  double value = 0.0;           // with each condition once
  double bias = 0.0;            // mean of the samples minus the value
  double standard_error = 0.0;  // NaN below two conditions
  Interval interval;            // clipped to the range; the whole range below two conditions
};

struct BootstrapOptions {
  int num_samples = 1000;
  ChanceBias chance_bias = ChanceBias::kNone;
  Interval range = {0.0, 1.0};  // of the statistic
  double confidence = 0.95;
};

// Deterministic: the same stream gives the same samples. Throws std::invalid_argument without conditions, or
// for fewer than two samples.
BootstrapEstimate BootstrapOverConditions(std::size_t num_conditions, const ConditionStatistic& statistic,
                                          const BootstrapOptions& options, RandomStream& rng);

}  // namespace rcme
