// The likelihood-ratio test whether a measured covariance of normal samples equals the predicted one
// (Anderson 2003, section 10.8; in photogrammetry Foerstner & Moonen 1999 compare covariance matrices by the
// same eigenvalues).
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace rcme {

struct CovarianceTest {
  // rho n [ln det S0 - ln det S + tr(S0^-1 S) - k] ~ chi2_(k (k + 1) / 2) for n degrees of freedom of S, with
  // Bartlett's correction rho = 1 - (2 k^2 + 3 k - 1) / (6 n (k + 1)). The size is correct to a few per cent
  // from n = 10 k on.
  double statistic = 0.0;
  int degrees_of_freedom = 0;
  double p_value = 1.0;
  // Generalised eigenvalues of (S, S0), ascending: measured over predicted variance, 1 if they are equal.
  Eigen::VectorXd variance_ratios;
  // Column i is v with v' S0 v = 1 and v' S v = variance_ratios(i): the combination v'e of the error's
  // coordinates whose variance is off by that ratio.
  Eigen::MatrixXd combinations;
  // Column i = S0 v: the direction in the space of the errors in which they are too long or too short.
  Eigen::MatrixXd directions;
};

// `measured` S and `predicted` S0 are k x k, in the same units; S has n >= k degrees of freedom: the number
// of errors if their mean is known to be zero, one less if their mean was subtracted. Throws
// std::invalid_argument if the sizes differ, n < k or S0 is not positive definite.
CovarianceTest TestCovariance(const Eigen::MatrixXd& measured, std::int64_t n,
                              const Eigen::MatrixXd& predicted);

// The same for errors that each have a predicted covariance: w = L^-1 e with Sigma = L L' should be N(0, I),
// so the second moment of w is tested against the identity. Coordinate i of w is the part of e_i that
// e_1..e_(i-1) do not predict, over its standard deviation. A bias shows as a ratio above 1. Works on a
// stream.
class WhitenedErrors {
 public:
  explicit WhitenedErrors(int dimension);

  // An error that is not finite, or whose covariance is not positive definite, cannot be whitened. It is
  // counted, and Test() then rejects.
  void Add(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance);
  void Merge(const WhitenedErrors& other);

  std::int64_t n() const { return n_; }
  std::int64_t num_not_whitened() const { return num_not_whitened_; }
  Eigen::MatrixXd second_moment() const { return sum_products_ / static_cast<double>(n_); }
  // p-value 0 and an infinite statistic if any error could not be whitened. Throws if n < k.
  CovarianceTest Test() const;

 private:
  Eigen::MatrixXd sum_products_;
  std::int64_t n_ = 0, num_not_whitened_ = 0;
};

}  // namespace rcme
