// Confidence sequence of a binomial probability: intervals that are valid at all sample sizes at once, so a
// study may look after every trial and stop at any time.
//
// The likelihood ratio of a beta mixture to p, after s successes in n trials,
//   M_n(p) = [B(a + s, b + n - s) / B(a, b)] / [p^s (1 - p)^(n - s)],
// is a non-negative martingale of mean 1 if p is the true probability, whatever the prior (a, b). By Ville's
// inequality P(M_n(p) >= 1 / alpha for any n) <= alpha. Hence the sets {p : M_n(p) < 1 / alpha} contain the
// true probability for all n together with probability at least 1 - alpha (Robbins 1970). The exact interval,
// looked at after every trial, has no such guarantee: in the long run it excludes the truth almost surely.
#pragma once

#include <cstdint>

#include "stats/intervals.h"

namespace rcme {

// The prior: the sequence is narrowest near a / (a + b), with the weight of a + b trials. The default
// (Jeffreys) prefers no probability. A wrong prior costs width, never validity.
struct BetaPrior {
  double a = 0.5, b = 0.5;
};

// log M_n(p), never -infinity; +infinity if p is impossible (0 after a success, 1 after a failure). exp(-log
// M) capped at 1 is an anytime-valid p-value of the hypothesis p.
double LogMixtureLikelihoodRatio(std::int64_t successes, std::int64_t n, double probability,
                                 const BetaPrior& prior = {});

// {p : M_n(p) < 1 / alpha}, alpha = 1 - confidence, after `successes` of `n`; [0, 1] at n = 0.
Interval ConfidenceSequence(std::int64_t successes, std::int64_t n, double confidence = 0.95,
                            const BetaPrior& prior = {});

}  // namespace rcme
