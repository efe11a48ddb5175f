// The level at which a non-decreasing rate crosses a value, x* = sup {x : rate(x) <= r}: for example the
// outlier ratio at which an estimator begins to fail in more than one of a hundred calls.
//
// It takes two parts on separate trials. A search (CrossingSearch) spends a first share of the trials where
// they are most informative about x*. It keeps posterior weights over the place of the crossing and the
// steepness of a logistic curve, and asks at their quantiles in turn (probabilistic bisection: Waeber,
// Frazier & Henderson 2013, with unknown response curve). Its assumptions need not hold, as it only chooses
// the levels x_0 < ... < x_(m-1) of the second part. The interval rests on the fresh trials of that part,
// whose number is fixed beforehand.
//
// The interval (FindCrossingInterval) assumes only that the rate does not fall. If x* lies between x_(c-1)
// and x_c, every level below c has a rate of at most r, so the number of events at any set of them is at most
// binomial of rate r; every level from c on has at least r. So c is rejected if the w levels just below c
// have too many events for rate r, or the w levels from c on too few, by an exact binomial test at alpha / (2
// K) for each of K widths w = 1, 2, 4, ..., m. The true c is rejected with probability at most alpha,
// whatever the curve. The interval is the hull of the places that are not rejected.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

// Levels are numbered 0, ..., num_levels - 1 and evenly spaced. A crossing is a place in [0, num_levels]; c
// means between level c - 1 and level c.
class CrossingSearch {
 public:
  // `rate` in (0, 1).
  CrossingSearch(size_t num_levels, double rate);

  void Add(size_t level, std::int64_t num_events, std::int64_t num_trials);

  // The level to ask next; `step` counts from 0.
  size_t NextLevel(size_t step) const;

  // Quantile of the posterior of the crossing; `probability` in [0, 1].
  double Quantile(double probability) const;

 private:
  size_t num_levels_;
  std::vector<double> log_rates_, log_rests_;  // of the curves, by steepness and by level - crossing
  std::vector<double> log_weights_;            // by steepness and crossing
};

struct EventsAtLevel {
  double level = 0.0;
  std::int64_t num_events = 0, num_trials = 0;
};

// The interval of x* in the units of the levels, which must ascend. An end is infinite if the crossing may
// lie beyond the first or the last level; both are if the numbers contradict a non-decreasing rate. Covers
// with at least `confidence`.
Interval FindCrossingInterval(std::span<const EventsAtLevel> events, double rate, double confidence = 0.95);

// The same if the log-odds of the rate are linear over the levels, which lie in [0, 1]: the likelihood-ratio
// interval of the crossing, profiled over the steepness. Several times narrower. It covers about `confidence`
// if the curve is nearly logistic over these levels.
Interval FindLogisticInterval(std::span<const EventsAtLevel> events, double rate, double confidence = 0.95);

struct Crossing {
  double estimate = 0.0;                       // posterior median from all trials, kept to `interval`
  Interval interval;                           // FindCrossingInterval of the fresh trials
  Interval logistic_interval;                  // FindLogisticInterval of the fresh trials
  std::vector<EventsAtLevel> searched, fresh;  // by step, and by level
};

// Runs `num_trials` new trials at a level in [0, 1] and returns their events. Trials without information are
// left out of the returned num_trials.
using AskLevel = std::function<EventsAtLevel(double level, std::int64_t num_trials)>;

// The crossing in [0, 1] from `num_trials` trials, at least 100, a third of them for the search. The estimate
// is NaN if no trial is informative. `place_of_run` gives the place at which the trials of a level are run,
// if the setting has few values, as whole numbers have: a non-decreasing function from [0, 1] to [0, 1].
using PlaceOfRun = std::function<double(double level)>;
Crossing FindCrossing(const AskLevel& ask, double rate, std::int64_t num_trials, double confidence = 0.95,
                      const PlaceOfRun& place_of_run = nullptr);

}  // namespace rcme
