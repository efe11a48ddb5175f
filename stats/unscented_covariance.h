#pragma once

#include <Eigen/Core>
#include <cmath>

namespace rcme {

// Second moment of `deviation`(x), a function R^n -> R^k that is zero at `mean`, for x ~ N(mean,
// standard_deviation^2 I), by the unscented transform (Julier, Uhlmann & Durrant-Whyte 2000). It uses 2 n
// points at mean +- sqrt(3) standard_deviation along each axis, of weight 1/6 each, which match the
// Gaussian's moments up to the fourth along every axis. The weight 1 - n/3 of the centre is negative for n >
// 3, so the spread is taken about the image of the centre, their form that stays positive semi-definite.
// Needs no derivative. Exact for linear functions and for quadratics of one coordinate; it ignores mixed
// second derivatives.
template <typename Function>
Eigen::MatrixXd UnscentedCovariance(const Function& deviation, const Eigen::VectorXd& mean,
                                    double standard_deviation) {
  const double step = std::sqrt(3.0) * standard_deviation;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd x = mean;
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    for (const double side : {step, -step}) {
      x(i) = mean(i) + side;
      const Eigen::VectorXd d = deviation(x);
      if (covariance.size() == 0) covariance.setZero(d.size(), d.size());
      covariance += d * d.transpose() / 6.0;
    }
    x(i) = mean(i);
  }
  return covariance;
}

}  // namespace rcme
