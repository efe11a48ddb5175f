// What a check can decide, computed before it runs.
//
// All at the last trial of a budget: a check that stops early has seen its verdict, so that these
// probabilities are lower bounds of those of the whole run. Rates: binomial, exact. Means of the probability
// integral transform: the sequence's width for the numbers expected under the law, and the normal scatter of
// their mean. Other means: normal, with the spread that the design expects.
#pragma once

#include "experiments/audit/claims/claim.h"

namespace rcme {

inline constexpr double kPowerOfDesign = 0.9;

struct TargetPower {
  // Of the verdict "holds", if the nominal value is the truth.
  double holds_at_nominal = 0.0;
  // True values outside are called "does not hold" with probability kPowerOfDesign; an infinite end: none
  // are.
  Interval found{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  // The same as relative errors of sigma, (assumed - true) / true, of a statistic with a chi-square law,
  // where this error is all that is wrong; NaN: it has no such law.
  Interval found_sigma{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
};

// Of a claimed target after `num_trials`, its interval at `confidence`.
TargetPower FindPower(const Target& target, std::int64_t num_trials, double confidence);

// The probability, at least, that every target of the claim holds, at all noise levels up to the asserted
// one, where all nominal values are the truth.
double HoldsAtNominal(const Claim& claim, Budget budget, double confidence);

// "sigma off by -4.2 or +4.5 %", "below 0.87", "below 0.4 or above 0.6".
std::string DescribeFound(const TargetPower& power);

}  // namespace rcme
