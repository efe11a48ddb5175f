#include "stats/covariance_test.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "stats/eigen_solvers.h"

namespace rcme {

CovarianceTest TestCovariance(const Eigen::MatrixXd& measured, std::int64_t n,
                              const Eigen::MatrixXd& predicted) {
  const Eigen::Index k = predicted.rows();
  if (predicted.cols() != k || measured.rows() != k || measured.cols() != k || k == 0) {
    throw std::invalid_argument("covariance test: matrices must be square and of one size");
  }
  if (n < k) throw std::invalid_argument("covariance test: fewer degrees of freedom than coordinates");
  if (Eigen::LLT<Eigen::MatrixXd>(predicted).info() != Eigen::Success) {
    throw std::invalid_argument("covariance test: predicted covariance is not positive definite");
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(measured, predicted);
  CovarianceTest test;
  test.variance_ratios = eigen.eigenvalues();
  test.combinations = eigen.eigenvectors();
  test.directions = predicted * test.combinations;
  const int dimension = static_cast<int>(k);
  test.degrees_of_freedom = dimension * (dimension + 1) / 2;
  // In the eigenvalues r: sum of r - 1 - ln r.
  double divergence = 0.0;
  for (const double r : test.variance_ratios) {
    divergence += r > 0.0 ? r - 1.0 - std::log(r) : std::numeric_limits<double>::infinity();
  }
  const double d = static_cast<double>(k), dof = static_cast<double>(n);
  const double bartlett = 1.0 - (2.0 * d * d + 3.0 * d - 1.0) / (6.0 * dof * (d + 1.0));
  test.statistic = bartlett * dof * divergence;
  test.p_value =
      std::isfinite(test.statistic)
          ? cdf(complement(boost::math::chi_squared(test.degrees_of_freedom), std::max(0.0, test.statistic)))
          : 0.0;
  return test;
}

WhitenedErrors::WhitenedErrors(int dimension) : sum_products_(Eigen::MatrixXd::Zero(dimension, dimension)) {}

void WhitenedErrors::Add(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  if (error.size() != sum_products_.rows() || covariance.rows() != error.size()) {
    throw std::invalid_argument("whitened errors: error or covariance of another dimension");
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  const Eigen::VectorXd whitened = llt.matrixL().solve(error);
  if (llt.info() != Eigen::Success || !whitened.allFinite()) {
    ++num_not_whitened_;
    return;
  }
  ++n_;
  sum_products_ += whitened * whitened.transpose();
}

void WhitenedErrors::Merge(const WhitenedErrors& other) {
  if (other.sum_products_.rows() != sum_products_.rows()) {
    throw std::invalid_argument("whitened errors: cannot merge another dimension");
  }
  sum_products_ += other.sum_products_;
  n_ += other.n_;
  num_not_whitened_ += other.num_not_whitened_;
}

CovarianceTest WhitenedErrors::Test() const {
  CovarianceTest test = TestCovariance(second_moment(), n_,
                                       Eigen::MatrixXd::Identity(sum_products_.rows(), sum_products_.rows()));
  if (num_not_whitened_ > 0) {
    test.statistic = std::numeric_limits<double>::infinity();
    test.p_value = 0.0;
  }
  return test;
}

}  // namespace rcme
