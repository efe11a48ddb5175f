#include "stats/point_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <vector>

#include "stats/random.h"

namespace rcme {
namespace {

constexpr PointSet kPointSets[] = {PointSet::kSobol, PointSet::kLatinHypercube, PointSet::kRandom};
const std::vector<std::uint64_t> kThreeAxes = {11, 22, 33};

// Joe & Kuo's points without the random bits, in Gray code's order, as published with new-joe-kuo-6.21201.
TEST(PointSet, SobolsKnownPoints) {
  const double known[8][3] = {{0, 0, 0},
                              {0.5, 0.5, 0.5},
                              {0.75, 0.25, 0.25},
                              {0.25, 0.75, 0.75},
                              {0.375, 0.375, 0.625},
                              {0.875, 0.875, 0.125},
                              {0.625, 0.125, 0.875},
                              {0.125, 0.625, 0.375}};
  const auto points = DrawPoints(PointSet::kSobol, 8, kThreeAxes, 5, 10);
  for (size_t d = 0; d < 3; ++d) {
    const std::uint64_t shift = RandomStream({5, kThreeAxes[d], 0, 10}).Next64();
    for (size_t i = 0; i < 8; ++i) {
      const auto bits = static_cast<std::uint64_t>(points[i][d] * 0x1p53) << 11;
      const double unshifted = static_cast<double>((bits ^ shift) >> 11) * 0x1p-53;
      EXPECT_EQ(unshifted, known[i][d]) << "point " << i << ", axis " << d;
    }
  }
}

TEST(PointSet, OneInEachNth) {
  for (const PointSet kind : {PointSet::kSobol, PointSet::kLatinHypercube}) {
    const auto points = DrawPoints(kind, 64, kThreeAxes, 1, 10);
    for (size_t d = 0; d < 3; ++d) {
      std::set<int> cells;
      for (const auto& point : points) cells.insert(static_cast<int>(std::floor(64.0 * point[d])));
      EXPECT_EQ(cells.size(), 64U);
      EXPECT_EQ(*cells.begin(), 0);
      EXPECT_EQ(*cells.rbegin(), 63);
    }
  }
}

TEST(PointSet, MorePointsContinueTheSequence) {
  for (const PointSet kind : {PointSet::kSobol, PointSet::kRandom}) {
    const auto few = DrawPoints(kind, 10, kThreeAxes, 1, 10), many = DrawPoints(kind, 100, kThreeAxes, 1, 10);
    for (size_t i = 0; i < 10; ++i) EXPECT_EQ(few[i], many[i]);
  }
}

TEST(PointSet, EachAxisHasItsOwnStreams) {
  for (const PointSet kind : kPointSets) {
    const auto points = DrawPoints(kind, 50, kThreeAxes, 1, 10);
    const auto fewer_axes = DrawPoints(kind, 50, std::vector<std::uint64_t>{11}, 1, 10);
    const auto other_seed = DrawPoints(kind, 50, kThreeAxes, 2, 10);
    int num_alike = 0;
    for (size_t i = 0; i < 50; ++i) {
      EXPECT_EQ(points[i][0], fewer_axes[i][0]);
      num_alike += points[i][0] == points[i][1] || points[i][0] == other_seed[i][0];
      for (const double x : points[i]) EXPECT_TRUE(x >= 0.0 && x < 1.0);
    }
    EXPECT_LT(num_alike, 3);
  }
}

// The mean of x1 x2 over 4,096 points, 1/4: random points miss it by 0.0055 (standard deviation), the others
// by a fraction of that. The bounds are four standard deviations of random points, and a tenth of that.
TEST(PointSet, IntegratesAProduct) {
  for (const PointSet kind : kPointSets) {
    double sum = 0.0;
    for (const auto& point : DrawPoints(kind, 4096, kThreeAxes, 1, 10)) sum += point[0] * point[1];
    EXPECT_NEAR(sum / 4096.0, 0.25, kind == PointSet::kSobol ? 0.0014 : 0.014);
  }
}

TEST(PointSet, FewOrTooManyAxes) {
  EXPECT_EQ(DrawPoints(PointSet::kSobol, 3, {}, 1, 10).size(), 3U);
  EXPECT_THROW(DrawPoints(PointSet::kSobol, 1, std::vector<std::uint64_t>(kMaxAxes + 1), 1, 10),
               std::invalid_argument);
}

}  // namespace
}  // namespace rcme
