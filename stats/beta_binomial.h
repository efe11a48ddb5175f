// How many of m new observations a split-conformal bound holds, whatever their law.
//
// The k-th smallest of n exchangeable scores is at least the share P of new scores, P ~ Beta(k, n + 1 - k)
// where no two are equal (Vovk 2012): its mean is k / (n + 1), and one calibration has more or less. Given P
// the m new ones are Binomial(m, P), so the number held is beta-binomial.
#pragma once

#include <cstdint>

namespace rcme {

// P(X <= successes), X ~ Binomial(n, P), P ~ Beta(a, b). Throws std::invalid_argument unless a, b > 0 and n
// >= 0.
double BetaBinomialCdf(std::int64_t successes, std::int64_t n, double a, double b);

}  // namespace rcme
