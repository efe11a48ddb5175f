// The number of m new observations that a split-conformal bound covers, whatever their law.
//
// Let P be the share of new scores up to the k-th smallest of n exchangeable scores. If no two scores are
// equal, P ~ Beta(k, n + 1 - k) (Vovk 2012), with mean k / (n + 1). Given P, the number of m new scores that
// are covered is Binomial(m, P), so it is beta-binomial.
#pragma once

#include <cstdint>

namespace rcme {

// P(X <= successes), X ~ Binomial(n, P), P ~ Beta(a, b). Throws std::invalid_argument unless a, b > 0 and n
// >= 0.
double BetaBinomialCdf(std::int64_t successes, std::int64_t n, double a, double b);

}  // namespace rcme
