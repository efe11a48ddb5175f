#include "stats/consistency.h"

#include <gtest/gtest.h>

#include <limits>

namespace rcme {
namespace {

TEST(NormalizedErrorSquared, ByHand) {
  // [[4, 1], [1, 3]]^-1 = [[3, -1], [-1, 4]] / 11; e = (1, 2): (3 - 2 - 2 + 16) / 11.
  const Eigen::Matrix2d covariance{{4.0, 1.0}, {1.0, 3.0}};
  EXPECT_NEAR(NormalizedErrorSquared(Eigen::Vector2d(1.0, 2.0), covariance), 15.0 / 11.0, 1e-15);
  EXPECT_EQ(NormalizedErrorSquared(Eigen::Vector2d(1.0, 2.0), Eigen::Matrix2d(Eigen::Matrix2d::Zero())),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace rcme
