// The rate of an event in a population of conditions, from trials in a random sample of conditions.
//
// Trials of one condition are alike. With intraclass correlation rho, n trials in each of m conditions have
// the information of m n / (1 + (n - 1) rho) independent ones (the design effect of Kish 1965, 8.2). An exact
// interval over all trials treats them as independent: at rho = 0.3 and 60 trials each it covers 0.35 or
// less.
//
// Condition i has n_i trials, of which the share q_i had the event, and the weight a_i (sum 1). With
//   p = sum a_i q_i,   M = 1 / sum a_i^2 (m at equal weights; Kish's effective number),
//   V = m / (m - 1) sum a_i^2 (q_i - p)^2,   B = p (1 - p) sum a_i^2 / n_i,
// V is the variance of p over samples of conditions, and B is that variance if all conditions have the same
// rate. Korn & Graubard (1998) treat p as the rate of p (1 - p) / V' independent trials, V' = V (t / z)^2 (t
// and z the quantiles of Student's law with M - 1 degrees of freedom and of the normal law), and use the
// exact interval for that number. This covers too little if few conditions dominate the rate. If these were
// not drawn, p and V are both too small (0.72 for 0.95 at 30 conditions, p = 0.01, rho = 0.3).
//
// The upper end of the exact interval is that after one more event. Here one more condition takes its place,
// with the share w of events, as Fay & Feuer (1997) add one event of the greatest weight to a weighted count.
// On the scale of sums over M conditions,
//   T = M p,  S = M^2 max(V', 0.6 B),   T' = T + w,  S' = S + w^2,  p' = T' / (M + w),
//   s = S' / (T' (1 - p')), kept to [s_0 / 2, 1], is the size of an event, in conditions,
//   s_0 = M B / (p (1 - p)) that of a single trial, and N = (M + w) / s;
//   upper end: the quantile of the beta law with the parameters p' N and (1 - p') N.
// The share w is found from the data. With the greatest share above the mean, r = max a_i M (q_i - p), kept
// to [s_0, 1], and the effective number of conditions that had the event, c = p^2 / sum a_i^2 q_i^2,
//   w = (1 + 3 / (c + 3)) / 2  r^(c / (c + 8 h)).
// With many such conditions it is half of the greatest (as the beta law of Jeffreys' prior has half an
// event); with few it is more than was seen, up to a condition that always has the event. h is near 0 if the
// conditions appear to have the same rate, else 1: h = max(G^4, 1 / (1 + (E / 10)^2)). E is the number of
// events and G the distribution function of (m - 1) V / B under a common rate, chi-square with m - 1 degrees
// of freedom. The lower end is one minus the upper end of the rate of non-events. Without an event the upper
// end is 1 - tail^(1 / M): each condition counts as a single trial.
//
// The numbers 3, 8, 10, 0.6 and the power 4 were chosen by simulation on a grid of laws. The coverage was
// measured on other draws and also on other laws (results/population/README.md;
// tests/stats/population_coverage.cc reproduces it). No interval narrower than 1 / m can account for
// conditions that were not drawn. If fewer than three conditions of the sample are expected to differ from
// all others, the interval covers only as often as one of these is drawn.
#pragma once

#include <cstdint>
#include <span>

#include "stats/intervals.h"

namespace rcme {

// The trials of one condition. Conditions without trials do not count.
struct ConditionCount {
  std::int64_t num_events = 0, num_trials = 0;
};

// The weights of the conditions in the rate.
enum class ConditionWeights {
  kEqual,    // a mean over conditions: a_i = 1 / m
  kByTrials  // a mean over trials, n_i being part of the population's law: a_i = n_i / sum n_i
};

struct PopulationRate {
  double value = 0.0;  // p; NaN without trials
  Interval interval;   // of the population's rate; [0, 1] below two conditions
  // Of the mean rate of exactly these conditions with infinitely many trials each: exact (Clopper & Pearson
  // 1934) for 1 / sum a_i^2 / n_i trials. By trials, or with equal n_i, conservative, since different rates
  // scatter less than equal ones (Hoeffding 1956); too short if a condition with a few trials weighs much.
  Interval of_these_conditions;
  // By analysis of variance; may be below zero. NaN if nothing varies, or if each condition has one trial.
  double intraclass_correlation = 0.0;
  // The number of independent trials with the same information: p (1 - p) / V, at most n. NaN if V = 0.
  double effective_n = 0.0;
  std::int64_t num_events = 0, n = 0, num_conditions = 0;
};

// Throws std::invalid_argument for counts outside 0..num_trials.
PopulationRate MeasurePopulationRate(std::span<const ConditionCount> conditions,
                                     ConditionWeights weights = ConditionWeights::kEqual,
                                     double confidence = 0.95);

// The trials of one condition with two events each, for example of two estimators.
struct ConditionPair {
  std::int64_t num_first_only = 0, num_second_only = 0;  // trials with only one of them
  std::int64_t num_trials = 0;
};

struct PopulationDifference {
  double value = 0.0;  // rate of the first minus that of the second
  // The interval for the population; [-1, 1] below two conditions. The difference is that of two rates, "only
  // the first" and "only the second", with the intervals [l1, u1] and [l2, u2] as above. They are combined
  // with the sample correlation r of the conditions' shares (Zou & Donner 2008):
  //   lower end: value - sqrt((p1 - l1)^2 + (u2 - p2)^2 - 2 r (p1 - l1) (u2 - p2)), the upper end likewise.
  Interval interval;
  PopulationRate first_only, second_only;
};

PopulationDifference MeasurePopulationDifference(std::span<const ConditionPair> conditions,
                                                 ConditionWeights weights = ConditionWeights::kEqual,
                                                 double confidence = 0.95);

// Kish's effective number of weights >= 0: (sum w)^2 / sum w^2. NaN for an empty list or zeros only.
double KishEffectiveNumber(std::span<const double> weights);

}  // namespace rcme
