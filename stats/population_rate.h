// The rate of an event in a population of conditions, from trials in conditions that are a random sample of
// it.
//
// Trials of one condition are alike: with the intraclass correlation rho, n trials in each of m conditions
// tell as much as m n / (1 + (n - 1) rho) independent ones (the design effect of Kish 1965, 8.2). An exact
// interval over all trials takes them for independent: at rho = 0.3 and 60 trials each it covers 0.35 and
// less.
//
// Condition i has n_i trials, the share q_i of which had the event, and the weight a_i (sum 1). With
//   p = sum a_i q_i,   M = 1 / sum a_i^2 (m at equal weights; Kish's effective number),
//   V = m / (m - 1) sum a_i^2 (q_i - p)^2,   B = p (1 - p) sum a_i^2 / n_i,
// V is the variance of p over samples of conditions, B what it were if all conditions had the same rate. Korn
// & Graubard (1998) take p as the rate of p (1 - p) / V' independent trials, V' = V (t / z)^2 (t and z the
// quantiles of Student's law of M - 1 degrees of freedom and of the normal one), and read off the exact
// interval of that many. This falls short where few conditions decide the rate: they were not drawn, and p
// and V are too small together (0.72 for 0.95 at 30 conditions, p = 0.01, rho = 0.3). The exact interval's
// upper end is that of one event more. Here one condition more takes its place, whose share of events is w:
// as Fay & Feuer (1997) add one event of the greatest weight to a weighted count. On the scale of sums over M
// conditions,
//   T = M p,  S = M^2 max(V', 0.6 B),   T' = T + w,  S' = S + w^2,  p' = T' / (M + w),
//   s = S' / (T' (1 - p')), kept to [s_0 / 2, 1], is the size of an event, in conditions,
//   s_0 = M B / (p (1 - p)) that of a single trial, and N = (M + w) / s;
//   upper end: the quantile of the beta law with the parameters p' N and (1 - p') N.
// How much of one condition more, w, is found from what was seen. With the greatest share above the mean, r =
// max a_i M (q_i - p), and the effective number of conditions that had the event, c = p^2 / sum a_i^2 q_i^2,
//   w = (1 + 3 / (c + 3)) / 2  r^(c / (c + 8 h)):
// of many such conditions, half of the greatest (as the beta law of Jeffreys' prior has half an event); of
// few, more than was seen, up to a condition that always has the event. h is near 0 where the conditions are
// seen to have the same rate, else 1: h = max(G^4, 1 / (1 + (E / 10)^2)), E the number of events and G the
// distribution function of (m - 1) V / B under a common rate, chi-square with m - 1 degrees of freedom. The
// lower end is one less the upper end of the rate of non-events. Without an event the upper end is 1 -
// tail^(1 / M): each condition counts as a single trial.
//
// The numbers 3, 8, 10, 0.6 and the power 4 are chosen by simulation on a grid of laws, and the coverage is
// measured on other draws and other laws too (results/population/README.md;
// tests/stats/population_coverage.cc makes it again). What no interval can do that is narrower than 1 / m:
// see conditions that were not drawn. A law under which fewer than three conditions of the sample are
// expected to differ from all others is covered as often as one is drawn.
#pragma once

#include <cstdint>
#include <span>

#include "stats/intervals.h"

namespace rcme {

// The trials of one condition. Conditions without trials do not count.
struct ConditionCount {
  std::int64_t num_events = 0, num_trials = 0;
};

// What the rate is a mean over.
enum class ConditionWeights {
  kEqual,    // conditions: a_i = 1 / m
  kByTrials  // trials, where a condition has as many as the population's law gives it: a_i = n_i / sum n_i
};

struct PopulationRate {
  double value = 0.0;  // p; NaN without trials
  Interval interval;   // of the population's rate; [0, 1] below two conditions
  // Of the mean of these very conditions' rates, were each tried for ever: exact (Clopper & Pearson 1934) of
  // 1 / sum a_i^2 / n_i trials. Cautious, since rates that differ scatter less than equal ones (Hoeffding
  // 1956).
  Interval of_these_conditions;
  // By analysis of variance; may be below zero. NaN where nothing varies, or each condition has one trial.
  double intraclass_correlation = 0.0;
  // So many independent trials would tell as much of the rate: p (1 - p) / V, at most n. NaN where V = 0.
  double effective_n = 0.0;
  std::int64_t num_events = 0, n = 0, num_conditions = 0;
};

// Throws std::invalid_argument for counts outside 0..num_trials.
PopulationRate MeasurePopulationRate(std::span<const ConditionCount> conditions,
                                     ConditionWeights weights = ConditionWeights::kEqual,
                                     double confidence = 0.95);

// The trials of one condition, each with two events, of two estimators say.
struct ConditionPair {
  std::int64_t num_first_only = 0, num_second_only = 0;  // trials with one of them
  std::int64_t num_trials = 0;
};

struct PopulationDifference {
  double value = 0.0;  // rate of the first less that of the second
  // Of the population; [-1, 1] below two conditions. The difference is that of two rates, "only the first"
  // and "only the second", with the intervals [l1, u1] and [l2, u2] above. They are put together with the
  // sample correlation r of the conditions' shares (Zou & Donner 2008):
  //   lower end: value - sqrt((p1 - l1)^2 + (u2 - p2)^2 - 2 r (p1 - l1) (u2 - p2)), the upper end likewise.
  Interval interval;
  PopulationRate first_only, second_only;
};

PopulationDifference MeasurePopulationDifference(std::span<const ConditionPair> conditions,
                                                 ConditionWeights weights = ConditionWeights::kEqual,
                                                 double confidence = 0.95);

// Kish's effective number of weights >= 0: (sum w)^2 / sum w^2. NaN of none, or of zeros alone.
double KishEffectiveNumber(std::span<const double> weights);

}  // namespace rcme
