#include "stats/spatial_pattern.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/moments.h"
#include "stats/random.h"

namespace rcme {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points DrawUniform(int n, double width, double height, RandomStream& rng) {
  Points points;
  for (int i = 0; i < n; ++i) points.emplace_back(rng.Uniform(0.0, width), rng.Uniform(0.0, height));
  return points;
}

TEST(ConvexHullArea, OfShapesWithKnownArea) {
  EXPECT_EQ(ConvexHullArea({}), 0.0);
  EXPECT_EQ(ConvexHullArea({{0, 0}, {3, 4}}), 0.0);
  EXPECT_EQ(ConvexHullArea({{0, 0}, {1, 1}, {2, 2}, {5, 5}}), 0.0);  // a line
  EXPECT_DOUBLE_EQ(ConvexHullArea({{0, 0}, {4, 0}, {0, 3}}), 6.0);
  // A square with points inside, on its border, and twice in a corner.
  EXPECT_DOUBLE_EQ(ConvexHullArea({{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 2}, {1, 1}, {1, 0}, {0.5, 1.5}}), 4.0);
  Points circle;  // a regular 1,000-gon: n / 2 sin(2 pi / n)
  for (int i = 0; i < 1000; ++i)
    circle.emplace_back(std::cos(2 * M_PI * i / 1000), std::sin(2 * M_PI * i / 1000));
  EXPECT_NEAR(ConvexHullArea(circle), 500 * std::sin(2 * M_PI / 1000), 1e-12);
}

TEST(MeanNearestNeighborDistance, IsThatOfAllPairs) {
  RandomStream rng({1, 0, 0, 1});
  for (const int n : {2, 3, 50, 400}) {
    Points points = DrawUniform(n, 640.0, 480.0, rng);
    points.push_back(points.front());  // one point twice
    double sum = 0.0;
    for (size_t i = 0; i < points.size(); ++i) {
      double nearest = 1e300;
      for (size_t j = 0; j < points.size(); ++j) {
        if (i != j) nearest = std::min(nearest, (points[i] - points[j]).norm());
      }
      sum += nearest;
    }
    EXPECT_DOUBLE_EQ(MeanNearestNeighborDistance(points), sum / static_cast<double>(points.size()));
  }
  EXPECT_TRUE(std::isnan(MeanNearestNeighborDistance({{1, 1}})));
}

// Complete randomness has mean 1; 2,000 patterns of 100 points, standard error about 0.001, 4 of them (6e-5).
// Without the correction for the border the index would be 1.04.
TEST(ClarkEvansIndex, IsOneOnAverageForCompleteRandomness) {
  Moments index;
  for (std::uint32_t trial = 0; trial < 2000; ++trial) {
    RandomStream rng({1, 0, trial, 1});
    index.Add(ClarkEvansIndex(DrawUniform(100, 640.0, 480.0, rng), 640.0, 480.0));
  }
  EXPECT_LT(index.standard_error(), 0.0015);
  EXPECT_NEAR(index.mean(), 1.0, 4.0 * index.standard_error() + 0.002);  // Donnelly's formula is a fit
}

// A square lattice has nearest neighbours at the spacing: twice what randomness gives, but for the border.
TEST(ClarkEvansIndex, IsNearTwoForASquareLatticeAndLowForOneCluster) {
  Points lattice, cluster;
  RandomStream rng({1, 0, 0, 1});
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 30; ++y) {
      lattice.emplace_back(16.0 * x + 8.0, 16.0 * y + 8.0);
      cluster.emplace_back(320.0 + 10.0 * rng.Normal(), 240.0 + 10.0 * rng.Normal());
    }
  }
  EXPECT_NEAR(ClarkEvansIndex(lattice, 640.0, 480.0), 2.0, 0.06);
  EXPECT_LT(ClarkEvansIndex(cluster, 640.0, 480.0), 0.2);
  EXPECT_TRUE(std::isnan(ClarkEvansIndex({}, 640.0, 480.0)));
}

}  // namespace
}  // namespace rcme
