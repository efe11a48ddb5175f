// What a check can decide, computed before it runs.
//
// All probabilities are for the last trial of a budget. A check that stops early has already reached its
// verdict, so these are lower bounds for the whole run. Rates: exact binomial. Means of the probability
// integral transform: the width of the sequence for the numbers expected under the law, and the normal
// scatter of their mean. Other means: normal, with the spread that the design expects.
#pragma once

#include "experiments/audit/claims/claim.h"

namespace rcme {

inline constexpr double kPowerOfDesign = 0.9;

struct TargetPower {
  // The probability of the verdict "holds" if the nominal value is the truth.
  double holds_at_nominal = 0.0;
  // True values outside this interval are called "does not hold" with probability kPowerOfDesign. An infinite
  // end: no value on this side is.
  Interval found{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  // The same as relative errors of sigma, (assumed - true) / true, for a statistic with a chi-square law, if
  // nothing else is wrong. NaN for another law.
  Interval found_sigma{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
};

// The power of a claimed target after `num_trials`, with its interval at `confidence`.
TargetPower FindPower(const Target& target, std::int64_t num_trials, double confidence);

// A lower bound of the probability that every target of the claim holds at all noise levels up to the
// asserted one, if all nominal values are the truth.
double HoldsAtNominal(const Claim& claim, Budget budget, double confidence);

// "sigma off by -4.2 or +4.5 %", "below 0.87", "below 0.4 or above 0.6".
std::string DescribeFound(const TargetPower& power);

}  // namespace rcme
