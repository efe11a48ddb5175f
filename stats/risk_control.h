// Certifying that a rate is at most a target, with a finite-sample bound on the probability of error.
//
// Of n trials with error rate at least r, at most k err with probability P(Binomial(n, r) <= k) or less. So a
// setting whose trials erred at most LargestCertifyingCount times violates the target with probability at
// most delta. For a threshold this is the order-statistic rule of Neyman-Pearson classification (Tong, Feng &
// Li 2018): the threshold is the least at which at most k of the trials lie on the wrong side, the (k+1)-th
// largest of the trials' own critical values. Several settings, in an order fixed without these trials, are
// certified one after the other until the first that is not: P(any of them violates) <= delta still
// (fixed-sequence testing; "Learn then Test", Angelopoulos et al. 2021).
//
// A rate among a part of the trials (false refusals: of the good ones) is judged given how many there are.
// The trials have to be independent; their rates may differ (as in a study's conditions): the sum of such
// trials is less spread than a binomial of the mean rate (Hoeffding 1956, for k <= n r - 1).
#pragma once

#include <cstdint>
#include <vector>

namespace rcme {

struct ErrorCount {
  std::int64_t errors = 0, n = 0;
};

// P(Binomial(n, at_most) <= errors): the p-value of "the rate is above at_most". 1 at n = 0.
double ExcessPValue(const ErrorCount& count, double at_most);

// The same of losses in [0, 1], independent and alike (the mean losses of groups), n of mean `mean`: the
// lesser of two bounds, Hoeffding's (1963) exp(-n KL(min(mean, at_most) || at_most)) and Bentkus' (2004) e
// P(Binomial(n, at_most) <= ceil(n mean)), as Bates et al. (2021) take them. Without a loss it is (1 -
// at_most)^n. 1 at n = 0.
double MeanLossPValue(double mean, std::int64_t n, double at_most);

// The most errors of n trials that certify `at_most` at level delta; -1 if not even zero errors would.
std::int64_t LargestCertifyingCount(std::int64_t n, double at_most, double delta);

// The fewest trials that can certify `at_most` at all, those without an error.
std::int64_t FewestCertifyingTrials(double at_most, double delta);

// The fewest trials that certify `at_most` with probability `power`, the rate being `rate`. Throws
// std::invalid_argument unless rate < at_most.
std::int64_t TrialsToCertify(double rate, double at_most, double delta, double power);

// How many of the settings are certified, from the first on, in this order: p-values at most delta.
std::size_t CountCertified(const std::vector<double>& p_values, double delta);

}  // namespace rcme
