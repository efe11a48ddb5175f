#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace rcme {

// Kolmogorov-Smirnov test of a sample against a fully known continuous law.
struct KolmogorovSmirnov {
  double statistic = 0.0;  // sup |F_n - F|
  double p_value = 1.0;    // asymptotic law with Stephens' correction; good for n >= 20
};
KolmogorovSmirnov TestKolmogorovSmirnov(std::vector<double> sample, const std::function<double(double)>& cdf);

// Anderson-Darling test of a sample against a fully known continuous law: like Kolmogorov-Smirnov, but it
// weighs the tails as much as the middle. A number where F is 0, 1 or NaN is impossible under the law: the
// statistic is infinite. (F rounds to 1 at 1 - 1e-16; a sample that reaches farther out needs its upper tail
// computed.)
struct AndersonDarling {
  double statistic = 0.0;  // A^2 = n int (F_n - F)^2 / (F (1 - F)) dF
  double p_value = 1.0;    // AndersonDarlingTail(statistic, n)
};
AndersonDarling TestAndersonDarling(const std::vector<double>& sample,
                                    const std::function<double(double)>& cdf);

// P(A^2 > statistic) for n >= 5 numbers: the limit law by its series, plus Marsaglia & Marsaglia's (2004)
// fitted correction for finite n; within 3e-4. The correction does not
// vanish in the far tail, so that a p-value is never below 6e-4 / n.
double AndersonDarlingTail(double statistic, std::int64_t n);

}  // namespace rcme
