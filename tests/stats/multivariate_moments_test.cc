#include "stats/multivariate_moments.h"

#include <gtest/gtest.h>

#include <vector>

#include "stats/moments.h"
#include "stats/random.h"

namespace rcme {
namespace {

TEST(MultivariateMoments, ByHand) {
  // (1, 2), (3, 6), (5, 1): means 3 and 3; squares 8 and 14, products (-2)(-1) + 0 * 3 + 2 (-2) = -2.
  MultivariateMoments moments(2);
  for (const auto& [x, y] : {std::pair{1.0, 2.0}, {3.0, 6.0}, {5.0, 1.0}}) moments.Add(Eigen::Vector2d(x, y));
  EXPECT_TRUE(moments.covariance().isApprox(Eigen::Matrix2d{{4.0, -1.0}, {-1.0, 7.0}}, 1e-15));
}

TEST(MultivariateMoments, DiagonalIsMoments) {
  RandomStream rng({.seed = 1, .purpose = 22});
  MultivariateMoments whole(3);
  std::vector<Moments> single(3);
  for (int i = 0; i < 1000; ++i) {
    Eigen::Vector3d x(rng.Normal(), 0.0, 1e3 * (i < 10 ? 1.0 : 0.0));
    x(1) = 0.5 * x(0) + rng.Normal();
    x(2) += rng.Normal();
    whole.Add(x);
    for (int k = 0; k < 3; ++k) single[static_cast<size_t>(k)].Add(x(k));
  }
  EXPECT_EQ(whole.covariance(), whole.covariance().transpose());
  for (int k = 0; k < 3; ++k) {
    EXPECT_DOUBLE_EQ(whole.covariance()(k, k), single[static_cast<size_t>(k)].variance());
  }
}

TEST(MultivariateMoments, TooFewVectorsAreNanAndOtherDimensionsAreRefused) {
  MultivariateMoments moments(2);
  moments.Add(Eigen::Vector2d(1.0, 2.0));
  EXPECT_TRUE(moments.covariance().array().isNaN().all());
  EXPECT_THROW(moments.Add(Eigen::Vector3d::Zero()), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
