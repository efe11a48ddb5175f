// Certifies that a rate is at most a target, with a finite-sample bound on the probability of error.
//
// If the error rate is at least r, n trials have at most k errors with probability at most P(Binomial(n, r)
// <= k). So a setting whose trials had at most LargestCertifyingCount errors violates the target with
// probability at most delta. For a threshold this is the order-statistic rule of Neyman-Pearson
// classification (Tong, Feng & Li 2018): the threshold is the least at which at most k trials lie on the
// wrong side, the (k+1)-th largest of the trials' critical values. Several settings, in an order fixed
// without these trials, are certified one after the other until the first failure: P(any certified one
// violates) <= delta still holds (fixed-sequence testing; "Learn then Test", Angelopoulos et al. 2021).
//
// A rate among a part of the trials (false refusals: among the good ones) is tested given the size of that
// part. The trials must be independent, but their rates may differ (between the conditions of a study): the
// number of errors then varies less than a binomial of the mean rate (Hoeffding 1956, for k <= n r - 1).
#pragma once

#include <cstdint>
#include <vector>

namespace rcme {

struct ErrorCount {
  std::int64_t errors = 0, n = 0;
};

// P(Binomial(n, at_most) <= errors): the p-value of "the rate is above at_most". 1 at n = 0.
double ExcessPValue(const ErrorCount& count, double at_most);

// The same for n independent, identically distributed losses in [0, 1] (mean losses of groups) with mean
// `mean`. The smaller of two bounds, as in Bates et al. (2021): Hoeffding's (1963) exp(-n KL(min(mean,
// at_most) || at_most)) and Bentkus' (2004) e P(Binomial(n, at_most) <= ceil(n mean)). Without a loss it is
// (1 - at_most)^n. 1 at n = 0.
double MeanLossPValue(double mean, std::int64_t n, double at_most);

// The largest number of errors in n trials that certifies `at_most` at level delta; -1 if even zero errors do
// not.
std::int64_t LargestCertifyingCount(std::int64_t n, double at_most, double delta);

// The smallest number of trials that can certify `at_most`: those without an error.
std::int64_t FewestCertifyingTrials(double at_most, double delta);

// The smallest number of trials that certifies `at_most` with probability `power` if the true rate is `rate`.
// Throws std::invalid_argument unless rate < at_most.
std::int64_t TrialsToCertify(double rate, double at_most, double delta, double power);

// The number of certified settings in this order: those before the first p-value above delta.
std::size_t CountCertified(const std::vector<double>& p_values, double delta);

}  // namespace rcme
