// Where a rate that rises with a level crosses a value, x* = sup {x : rate(x) <= r}: the outlier ratio, say,
// at which an estimator begins to fail more often than once in a hundred calls.
//
// Two parts, on separate trials. A search (CrossingSearch) spends a first share of the trials where they tell
// most about x*: it keeps posterior weights over the place of the crossing and the steepness of a logistic
// curve, and asks at their quantiles in turn (probabilistic bisection: Waeber, Frazier & Henderson 2013, with
// the response curve unknown). It may be as wrong as it likes: it only chooses the levels x_0 < ... < x_(m-1)
// of the second part, on whose fresh trials, as many as were fixed beforehand, the interval rests.
//
// The interval (FindCrossingInterval) supposes that the rate does not fall, and nothing else. If x* lies
// between x_(c-1) and x_c, then every level below c has a rate of at most r, and the number of events at any
// set of them is at most binomial of rate r; every level from c on has at least r. So c is rejected if the w
// levels just below c have too many events for rate r, or the w from c on too few, by an exact binomial test
// at alpha / (2 K) for each of K widths w = 1, 2, 4, ..., m. The true c is rejected with probability alpha at
// most, whatever the curve; the interval is the hull of what is not rejected.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

// Levels are numbered 0, ..., num_levels - 1 and evenly spaced. A crossing is a place in [0, num_levels]:
// between level c - 1 and level c it is c.
class CrossingSearch {
 public:
  // `rate` in (0, 1).
  CrossingSearch(size_t num_levels, double rate);

  void Add(size_t level, std::int64_t num_events, std::int64_t num_trials);

  // Where to ask next; `step` counts from 0.
  size_t NextLevel(size_t step) const;

  // Of the posterior of the crossing, `probability` in [0, 1].
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

// Of x*, in the units of the levels, which ascend; an end is infinite where the crossing may lie beyond the
// first or the last level, and both are if the numbers contradict a rate that does not fall. Covers with
// probability `confidence` or more.
Interval FindCrossingInterval(std::span<const EventsAtLevel> events, double rate, double confidence = 0.95);

// The same if the log-odds of the rate are linear over the levels, which lie in [0, 1]: likelihood-ratio
// interval of the crossing, over the steepness. Several times narrower; it covers about `confidence` where
// the curve is nearly logistic over these levels.
Interval FindLogisticInterval(std::span<const EventsAtLevel> events, double rate, double confidence = 0.95);

struct Crossing {
  double estimate = 0.0;                       // the posterior's median, of all trials
  Interval interval;                           // FindCrossingInterval of the second part
  Interval logistic_interval;                  // FindLogisticInterval of the second part
  std::vector<EventsAtLevel> searched, fresh;  // by step, and by level
};

// The events in so many new trials at a level in [0, 1]; trials that tell nothing are not among those of the
// answer.
using AskLevel = std::function<EventsAtLevel(double level, std::int64_t num_trials)>;

// The crossing in [0, 1], from `num_trials` trials, at least 100: a third of them for the search. The
// estimate is NaN if no trial tells anything.
Crossing FindCrossing(const AskLevel& ask, double rate, std::int64_t num_trials, double confidence = 0.95);

}  // namespace rcme
