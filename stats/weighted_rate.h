// The rate of an event from weighted trials (importance sampling, stats/tilted_binomial.h).
#pragma once

#include <cstdint>

#include "stats/intervals.h"

namespace rcme {

// Sums over the trials. Weights are >= 0 and have mean 1 under the law of the draw.
struct WeightedEvents {
  std::int64_t num_trials = 0;
  double max_weight = 0.0;  // of all trials
  // Over the trials with the event: sum of the weights, sum of their squares, greatest weight.
  double sum_weights = 0.0, sum_squared_weights = 0.0, max_event_weight = 0.0;

  void Add(double weight, bool happened);
  void Merge(const WeightedEvents& other);
};

struct WeightedRate {
  double estimate = 0.0;        // sum w / n: unbiased
  double standard_error = 0.0;  // from the sample variance of w x, x = 1 with the event, else 0
  // The number of events of equal weight with the same relative error: (sum w)^2 / sum w^2.
  double num_effective_events = 0.0;
  Interval interval;            // valid if no events of large weight are missed, see below
  double cautious_upper = 0.0;  // upper end without this assumption
};

// The 95 % interval is the gamma interval of Fay & Feuer (1997) for a weighted sum of Poisson counts. With y
// = sum w, v = sum w^2 over the events and G(shape, scale) a gamma law,
//   lower: tail of G(y^2 / v, v / y),  upper: tail of G((y + m)^2 / (v + m^2), (v + m^2) / (y + m)),
// both divided by n. These laws have the mean and the variance of the sum, for the upper end after one more
// event of weight m. At equal weights this is the exact interval of a Poisson count (Garwood 1936).
//
// It assumes that events are a Poisson count within each weight, so rare there; otherwise it is too wide.
//
// It also assumes that m bounds the weights of events. Fay & Feuer take the greatest possible weight;
// cautious_upper takes the greatest of any trial. That is never below 3.7 m / n, and therefore useless for
// rates far below 1 / n, the reason for weighting in the first place. `interval` takes the greatest weight of
// an event (of a trial, at least 1, if no event was seen: then both are equal). It thereby assumes that
// weights without an observed event contribute little to the rate. The sample itself cannot show whether this
// is true: an event that is rare at its typical weight and frequent only at small ones gives an estimate that
// looks settled and is orders of magnitude too low. For Binomial(100, p), p = 0.2 tilted to 0.5, 2,000
// trials, and an event whose odds grow by a factor e^s with every unit of K, the 95 % interval covers a rate
// of
//   1e-2 in 96 %, 1e-4 in 96 %, 1e-6 in 95 % of the samples at s = 2,
//   1e-2 in 96 %, 1e-4 in 88 %, 1e-6 in 66 % at s = 1,
//   1e-2 in 95 %, 1e-4 in 56 %, 1e-6 in 13 % at s = 0.5:
// use it if the event is known to depend strongly on the tilted quantity. [0, infinity] without trials.
WeightedRate EstimateWeightedRate(const WeightedEvents& events);

}  // namespace rcme
