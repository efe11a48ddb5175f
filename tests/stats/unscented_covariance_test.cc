#include "stats/unscented_covariance.h"

#include <gtest/gtest.h>

namespace rcme {
namespace {

TEST(UnscentedCovariance, IsExactForLinearFunctions) {
  Eigen::MatrixXd J(2, 5);
  J << 1.0, -2.0, 0.5, 3.0, 0.0, 4.0, 0.1, -1.0, 2.0, 7.0;
  const Eigen::VectorXd mean = Eigen::VectorXd::LinSpaced(5, -2.0, 2.0);
  const auto deviation = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return J * (x - mean); };
  const Eigen::MatrixXd expected = 0.09 * J * J.transpose();
  EXPECT_LT((UnscentedCovariance(deviation, mean, 0.3) - expected).norm(), 1e-13 * expected.norm());
}

TEST(UnscentedCovariance, IsExactForTheSquareOfOneCoordinate) {
  // E[(x^2 - mu^2)^2] = 4 mu^2 s^2 + 3 s^4 for x ~ N(mu, s^2), beside a coordinate that does nothing.
  const Eigen::Vector2d mean(1.5, -4.0);
  const auto deviation = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return Eigen::VectorXd::Constant(1, x(0) * x(0) - mean(0) * mean(0));
  };
  for (const double s : {0.1, 1.0, 10.0}) {
    const double expected = 4.0 * 1.5 * 1.5 * s * s + 3.0 * s * s * s * s;
    EXPECT_NEAR(UnscentedCovariance(deviation, mean, s)(0, 0), expected, 1e-12 * expected);
  }
}

}  // namespace
}  // namespace rcme
