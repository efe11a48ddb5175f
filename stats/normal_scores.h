// Proper scores of a stated normal density N(0, Sigma) for the error e that occurred. Both reward a density
// that is correct and sharp, and are least, on average, for the true one; coverage alone cannot distinguish a
// sharp density from a wide one (Gneiting & Raftery 2007, "Strictly Proper Scoring Rules, Prediction, and
// Estimation", sections 4.1 and 4.3). Smaller is better; in the paper both have the opposite sign.
//
// Logarithmic score: -ln N(e; 0, Sigma) = (e' Sigma^-1 e + ln det Sigma + d ln 2 pi) / 2, in nats. A singular
// Sigma has no density and no score.
//
// Energy score: E|X - e| - E|X - X'| / 2 for independent X, X' ~ N(0, Sigma), in the unit of e. It is finite
// for every covariance, and |e| for Sigma = 0. In one dimension it is the continuous ranked probability
// score. Both terms are mean lengths of a normal vector, as X - X' is sqrt(2) X. For Q = |X - e|^2, with the
// eigenvalues l_i of Sigma and the coordinates y_i of e along its eigenvectors,
//   M(t) = E exp(-t Q) = prod_i (1 + 2 l_i t)^(-1/2) exp(-t y_i^2 / (1 + 2 l_i t)),
//   E sqrt(Q) = pi^(-1/2) int_0^inf -M'(t) t^(-1/2) dt,
//   -M'(t) = M(t) sum_i [l_i / (1 + 2 l_i t) + y_i^2 / (1 + 2 l_i t)^2],
// since int_0^inf q exp(-t q) t^(-1/2) dt = sqrt(pi q). With t = exp(u) / E Q the integrand falls
// exponentially on both sides, and the trapezoidal rule converges exponentially with the step (Trefethen &
// Weideman 2014). Nothing is random: the score is a function of e and Sigma alone, computed in some
// microseconds with a relative accuracy of 1e-7.
#pragma once

#include <Eigen/Core>

namespace rcme {

// E|X - e| for X ~ N(0, diag(variances)), all at least 0. Relative accuracy 1e-8.
double MeanDistance(const Eigen::VectorXd& variances, const Eigen::VectorXd& e);

// `covariance` is d x d, symmetric and positive semidefinite.
double EnergyScore(const Eigen::VectorXd& e, const Eigen::MatrixXd& covariance);

// ln det Sigma; NaN if it is not positive definite.
double LogDeterminant(const Eigen::MatrixXd& covariance);

// From e' Sigma^-1 e (stats/consistency.h) and ln det Sigma of `dimension` coordinates.
double LogScore(double normalized_error_squared, double log_determinant, int dimension);

}  // namespace rcme
