// Two methods on the same trials: is their difference in success more than chance?
#pragma once

#include <cstdint>

#include "stats/intervals.h"

namespace rcme {

struct PairedCounts {
  std::int64_t both = 0, first_only = 0, second_only = 0,
               neither = 0;  // trials in which the event happened to

  void Add(bool first, bool second) {
    ++(first ? (second ? both : first_only) : (second ? second_only : neither));
  }
  void Merge(const PairedCounts& other);
  std::int64_t n() const { return both + first_only + second_only + neither; }
  // Rate of the first minus rate of the second.
  double RiskDifference() const;
};

// McNemar's exact test of equal rates: given the number of trials in which only one had the event, which one
// is a coin's choice. Two-sided p-value, 2 P(X <= min) with X ~ Binomial(first_only + second_only, 1/2), at
// most 1.
double McNemarExactPValue(const PairedCounts& counts);

// The same for a study that looks and stops when it likes: the discordant trials are tosses of a coin, fair
// if the rates are equal, and M, the likelihood ratio of the mixture of all coins to the fair one
// (stats/confidence_sequence.h), exceeds 1 / a at any time with probability at most a, whatever the stopping
// depends on. 1 / M, at most 1.
double AnytimeMcNemarPValue(const PairedCounts& counts);

// Tango's (1998) score interval of the risk difference d: the d with |z(d)| <= z_(1 - alpha / 2),
//   z(d) = (first_only - second_only - n d) / sqrt(n (2 q + d (1 - d))),
// q the maximum-likelihood probability of `second_only` at d. Works where no event was seen at all; [-1, 1]
// at n = 0.
Interval RiskDifferenceInterval(const PairedCounts& counts, double confidence = 0.95);

}  // namespace rcme
