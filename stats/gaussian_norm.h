// The length |e| of a normal vector e of mean 0 whose covariance has the eigenvalues l1 >= l2 >= l3 >= 0 (in
// two dimensions l3 = 0). |e|^2 = l1 z1^2 + l2 z2^2 + l3 z3^2 with independent standard normal z.
//
// Write (z1, z2) in polar coordinates: l1 z1^2 + l2 z2^2 = s(p) w with s(p) = l1 cos^2 p + l2 sin^2 p, p
// uniform, and w independent of p and chi-square with 2 degrees of freedom, so P(w > x) = exp(-x / 2). Given
// p,
//   P(s w + l3 z3^2 > r^2) = P(l3 z3^2 > r^2) + E[exp(-(r^2 - l3 z3^2) / (2 s)); l3 z3^2 <= r^2]
//                          = erfc(r / sqrt(2 l3)) + exp(-r^2 / (2 s)) erf(r sqrt(v / (2 l3))) / sqrt(v),
// v = 1 - l3 / s >= 0; for two eigenvalues it is exp(-r^2 / (2 s)) alone. Averaging over p gives
//   P(|e| > r) = erfc(r / sqrt(2 l3)) + (2 / pi) int_0^(pi/2) exp(-r^2 / (2 s)) erf(...) / sqrt(v) dp.
// With l2 = l3 = 0 it is Craig's (1991) form of the normal tail. Nothing cancels, so small probabilities keep
// their digits. The integrand is smooth and periodic, so the trapezoidal rule converges faster than any power
// (Trefethen & Weideman 2014). The number of points is doubled until two sums agree to 1e-13, relative.
//
// Relative accuracy of the quantile: 1e-12, for probabilities from 1e-12 to .999 and any ratio of the
// eigenvalues. Tested against closed forms (normal, Rayleigh, Maxwell), against Imhof's
// (1961) integral and by simulation.
#pragma once

#include <Eigen/Core>

namespace rcme {

// The r with P(|e| > r) = tail; 0 if e is 0. Throws std::invalid_argument with the reason if an eigenvalue is
// not finite or negative, or tail is outside of [1e-300, 1).
double GaussianNormQuantile(const Eigen::Vector3d& eigenvalues, double tail);

// The same if e has these eigenvalues with probability 1 - weight, and those of `other` with probability
// `weight`, in [0, 1].
double GaussianNormQuantile(const Eigen::Vector3d& eigenvalues, const Eigen::Vector3d& other, double weight,
                            double tail);

// P(|e| > r), r >= 0. Throws for such eigenvalues likewise.
double GaussianNormTail(const Eigen::Vector3d& eigenvalues, double r);

}  // namespace rcme
