// Importance sampling of a binomial number.
//
// It estimates the rate of an event that is rare for K ~ Binomial(n, p) and frequent for other K. K is drawn
// from another law: U uniform between p and q, then K ~ Binomial(n, U). Each draw has the weight
//   w(K) = P_p(K) / P_mix(K),  P_mix(k) = 1 / |q - p| int_[p, q] Binom(k; n, u) du,
// so E_mix[w(K) g(K)] = E_p[g(K)] for any g: the estimate is unbiased for every q.
//
// The integral has a closed form: (n + 1) Binom(k; n, u) is the density of Beta(k + 1, n - k + 1) at u, hence
//   P_mix(k) = |I_q(k + 1, n - k + 1) - I_p(k + 1, n - k + 1)| / ((n + 1) |q - p|)
// with the regularised incomplete beta function I.
#pragma once

namespace rcme {

// w(k) for 0 <= k <= n, n >= 1, p and q in [0, 1]; 1 for p = q. Finite and never negative. For q > p it falls
// with k from (n + 1) (q - p) / (1 - p) at k = 0 (slightly more if q is close to p); for q < p it rises to (n
// + 1) (p - q) / p at k = n. Relative error below 1e-10 for n up to 1e6.
double TiltedBinomialWeight(int k, int n, double p, double q);

}  // namespace rcme
