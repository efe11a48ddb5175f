// Comparison of two methods on the same trials: tests whether their rates of an event differ.
#pragma once

#include <cstdint>

#include "stats/intervals.h"

namespace rcme {

struct PairedCounts {
  std::int64_t both = 0, first_only = 0, second_only = 0,
               neither = 0;  // trials in which the event happened to both, one or neither

  void Add(bool first, bool second) {
    ++(first ? (second ? both : first_only) : (second ? second_only : neither));
  }
  void Merge(const PairedCounts& other);
  std::int64_t n() const { return both + first_only + second_only + neither; }
  // Rate of the first minus that of the second.
  double RiskDifference() const;
};

// McNemar's exact test of equal rates: given the number of discordant trials, in which only one method had
// the event, which one is a fair coin. Two-sided p-value, 2 P(X <= min) with X ~ Binomial(first_only +
// second_only, 1/2), at most 1.
double McNemarExactPValue(const PairedCounts& counts);

// The anytime-valid version, for studies that look and stop at will. The discordant trials are tosses of a
// coin, fair if the rates are equal. M, the likelihood ratio of the mixture of all coins to the fair one
// (stats/confidence_sequence.h), ever exceeds 1 / a with probability at most a. The p-value is 1 / M, at most
// 1.
double AnytimeMcNemarPValue(const PairedCounts& counts);

// Tango's (1998) score interval of the risk difference d: the d with |z(d)| <= z_(1 - alpha / 2),
//   z(d) = (first_only - second_only - n d) / sqrt(n (2 q + d (1 - d))),
// q the maximum-likelihood probability of `second_only` at d. Valid also if no event was seen; [-1, 1] at n =
// 0.
Interval RiskDifferenceInterval(const PairedCounts& counts, double confidence = 0.95);

}  // namespace rcme
