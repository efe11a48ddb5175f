// The sums against a loop over all pairs as robust_covariance/residual_variances.h states them, on every
// instruction set.
#include "estimator/kernels/correlated_pairs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "stats/random.h"
#include "tests/test_support/every_target.h"

namespace rcme {
namespace {

class CorrelatedPairs : public OnEveryTarget {};

constexpr int kLengths = kNumCorrelationLengths;
constexpr size_t kPairSizes[] = {1, 2, 7, 8, 9, 16, 17, 63, 65, 150};

struct Point {
  std::array<double, 4> at, normal;  // over the longest length
  double residual, weight;
  std::array<double, 5> row;
};

// The first `num_repeated` have several matches. Some lie upon each other, one too far from all for any
// correlation.
std::vector<Point> DrawPoints(size_t num_points, size_t num_repeated) {
  RandomStream rng({.seed = 1, .trial = static_cast<std::uint32_t>(num_points), .purpose = 2712});
  std::vector<Point> points(num_points);
  for (size_t i = 0; i < num_points; ++i) {
    Point& point = points[i];
    for (double& x : point.at) x = 3.0 * rng.Uniform();
    if (i % 11 == 10) point.at = points[i - 1].at;
    if (i == 5) point.at[2] = 1e6;
    double squares = 0.0;
    for (double& x : point.normal) {
      x = rng.Normal();
      squares += x * x;
    }
    for (double& x : point.normal) x /= std::sqrt(squares);
    point.residual = rng.Normal();
    point.weight = i < num_repeated ? 1.0 / static_cast<double>(2 + i % 3) : 1.0;
    for (double& x : point.row) x = rng.Normal();
  }
  return points;
}

std::vector<CorrelatedBlock> Pack(const std::vector<Point>& points) {
  std::vector<CorrelatedBlock> blocks((points.size() + kBlockSize - 1) / kBlockSize);
  for (size_t i = 0; i < points.size(); ++i) {
    CorrelatedBlock& block = blocks[i / kBlockSize];
    const size_t lane = i % kBlockSize;
    for (size_t k = 0; k < 4; ++k) {
      block.at[k][lane] = points[i].at[k] / kDistanceUnit;
      block.normal[k][lane] = points[i].normal[k];
    }
    block.residual[lane] = points[i].residual;
    block.weight[lane] = points[i].weight;
    for (size_t j = 0; j < 5; ++j) {
      block.row[j][lane] = points[i].row[j];
      block.excess[j][lane] = (points[i].weight - 1.0) * points[i].row[j];
    }
  }
  return blocks;
}

std::array<double, kLengths> Correlate(const Point& g, const Point& h) {
  std::array<double, kLengths> c = {};
  for (size_t image = 0; image < 2; ++image) {
    const size_t x = 2 * image, y = x + 1;
    const double cosine = g.normal[x] * h.normal[x] + g.normal[y] * h.normal[y];
    const double distance = std::hypot(g.at[x] - h.at[x], g.at[y] - h.at[y]);
    c[0] += cosine * std::exp(-9.0 * distance);
    c[1] += cosine * std::exp(-3.0 * distance);
    c[2] += cosine * std::exp(-distance);
  }
  return c;
}

CorrelatedPairSums SumByHand(const std::vector<Point>& points) {
  CorrelatedPairSums sums;
  sums.smoothed.resize((points.size() + kBlockSize - 1) / kBlockSize);
  for (size_t g = 0; g < points.size(); ++g) {
    for (size_t h = 0; h < points.size(); ++h) {
      if (g == h) continue;
      const std::array<double, kLengths> c = Correlate(points[g], points[h]);
      SmoothedBlock& smoothed = sums.smoothed[g / kBlockSize];
      for (size_t k = 0, i = 0; k < kLengths; ++k) {
        for (size_t j = 0; j < 5; ++j) {
          smoothed.row[k][j][g % kBlockSize] += c[k] * points[h].row[j];
          smoothed.mean[k][j][g % kBlockSize] += c[k] * points[h].weight * points[h].row[j];
        }
        if (h > g) continue;
        sums.products[k] += c[k] * points[g].residual * points[h].residual;
        for (size_t m = 0; m <= k; ++m, ++i) {
          sums.squares[i] += c[k] * c[m];
          sums.weighted[i] += c[k] * c[m] * points[g].weight * points[h].weight;
        }
      }
    }
  }
  return sums;
}

// Calls check(points, num_repeated) with none, some and all of the points repeated.
template <typename Check>
void ForEachSize(const Check& check) {
  for (const size_t n : kPairSizes) {
    for (const size_t num_repeated : {size_t{0}, (n + 4) / 5, n}) {
      SCOPED_TRACE(testing::Message() << n << " points, " << num_repeated << " of several matches");
      check(DrawPoints(n, num_repeated), num_repeated);
    }
  }
}

TEST_F(CorrelatedPairs, EqualTheLoopOverAllPairs) {
  ForEachSize([](const std::vector<Point>& points, size_t num_repeated) {
    const CorrelatedPairSums expected = SumByHand(points);
    const double bound = 1e-12 * static_cast<double>(points.size());  // terms are below a few
    Run([&] {
      const CorrelatedPairSums sums = SumCorrelatedPairs(Pack(points), num_repeated);
      for (size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(sums.squares[i], expected.squares[i], bound * static_cast<double>(points.size()));
        EXPECT_NEAR(sums.weighted[i], expected.weighted[i], bound * static_cast<double>(points.size()));
      }
      for (size_t k = 0; k < kLengths; ++k)
        EXPECT_NEAR(sums.products[k], expected.products[k], bound * static_cast<double>(points.size()));
      for (size_t g = 0; g < points.size(); ++g) {
        for (size_t k = 0; k < kLengths; ++k) {
          for (size_t j = 0; j < 5; ++j) {
            const SmoothedBlock &found = sums.smoothed[g / kBlockSize],
                                &wanted = expected.smoothed[g / kBlockSize];
            ASSERT_NEAR(found.row[k][j][g % kBlockSize], wanted.row[k][j][g % kBlockSize], bound) << g;
            ASSERT_NEAR(found.mean[k][j][g % kBlockSize], wanted.mean[k][j][g % kBlockSize], bound) << g;
          }
        }
      }
    });
  });
}

TEST_F(CorrelatedPairs, AreTheSameBitsOnEveryInstructionSet) {
  ForEachSize([](const std::vector<Point>& points, size_t num_repeated) {
    std::optional<CorrelatedPairSums> first;
    Run([&] {
      const CorrelatedPairSums sums = SumCorrelatedPairs(Pack(points), num_repeated);
      if (!first) first = sums;
      EXPECT_EQ(std::memcmp(sums.squares, first->squares, sizeof sums.squares), 0);
      EXPECT_EQ(std::memcmp(sums.weighted, first->weighted, sizeof sums.weighted), 0);
      EXPECT_EQ(std::memcmp(sums.products, first->products, sizeof sums.products), 0);
      EXPECT_EQ(std::memcmp(sums.smoothed.data(), first->smoothed.data(),
                            sums.smoothed.size() * sizeof(SmoothedBlock)),
                0);
    });
  });
}

TEST_F(CorrelatedPairs, OfNoPointsThereAreNone) {
  Run([] {
    const CorrelatedPairSums sums = SumCorrelatedPairs({}, 0);
    EXPECT_TRUE(sums.smoothed.empty());
    EXPECT_EQ(sums.squares[5], 0.0);
  });
}

}  // namespace
}  // namespace rcme
