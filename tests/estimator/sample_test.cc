#include "estimator/sample.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "stats/distributions.h"
#include "stats/random.h"

namespace rcme {
namespace {

TEST(DrawSample, IndicesAreDistinctAndInRange) {
  RandomStream rng({1, 0, 0, 4});
  for (int draw = 0; draw < 1000; ++draw) {
    const Sample sample = DrawSample(8, 8, rng);
    EXPECT_EQ(std::set<int>(sample.begin(), sample.end()), (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7}));
  }
}

// Every one of the 45 sets of 8 out of 10 is equally likely: chi-square with 44 degrees of freedom over
// 45,000 draws, at 1e-5. A set drawn 10 % too often alone adds 10 to the statistic's 44 +- 9.
TEST(DrawSample, EverySetIsEquallyLikely) {
  RandomStream rng({1, 0, 0, 4});
  std::map<std::set<int>, int> counts;
  for (int draw = 0; draw < 45'000; ++draw) {
    const Sample sample = DrawSample(8, 10, rng);
    ++counts[std::set<int>(sample.begin(), sample.end())];
  }
  EXPECT_EQ(counts.size(), 45u);
  double statistic = 0.0;
  for (const auto& [set, count] : counts) statistic += (count - 1000.0) * (count - 1000.0) / 1000.0;
  EXPECT_LT(statistic, ChiSquareQuantile(44, 1.0 - 1e-5));
}

}  // namespace
}  // namespace rcme
