#include "simulator/split_by_shares.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "stats/random.h"

namespace rcme {
namespace {

using testing::ElementsAre;

TEST(SplitByShares, GivesWhatIsMissingToTheLargestRemainders) {
  EXPECT_THAT(SplitByShares(100, {0.8, 0.2}), ElementsAre(80, 20));
  EXPECT_THAT(SplitByShares(3, {0.5, 0.3, 0.2}), ElementsAre(1, 1, 1));     // 1.5, 0.9, 0.6
  EXPECT_THAT(SplitByShares(10, {0.16, 0.7, 0.14}), ElementsAre(2, 7, 1));  // 1.6, 7, 1.4
  EXPECT_THAT(SplitByShares(0, {0.5, 0.5}), ElementsAre(0, 0));
  EXPECT_THAT(SplitByShares(7, {1.0}), ElementsAre(7));
  EXPECT_THAT(SplitByShares(7, {0.0, 1.0, 0.0}), ElementsAre(0, 7, 0));
}

TEST(SplitByShares, OfEqualRemaindersTheFirstGetOneMore) {
  EXPECT_THAT(SplitByShares(500, {1.0, 1.0, 1.0}), ElementsAre(167, 167, 166));
  EXPECT_THAT(SplitByShares(2, {0.25, 0.25, 0.25, 0.25}), ElementsAre(1, 1, 0, 0));
}

TEST(SplitByShares, SharesThatAreRoundedCountsComeOutAsThoseCounts) {
  for (int total = 1; total <= 500; ++total) {
    for (int part = 0; part <= total; part += 1 + total / 20) {
      const double share = static_cast<double>(part) / total;
      ASSERT_THAT(SplitByShares(total, {share, 1.0 - share}), ElementsAre(part, total - part));
    }
  }
}

TEST(SplitByShares, SumsToTheTotalAndIsWithinOneOfEveryExactShare) {
  RandomStream rng({1, 0, 0, 1});
  for (int round = 0; round < 5000; ++round) {
    std::vector<double> shares(1 + rng.IntegerBelow(20));
    for (double& share : shares) share = rng.Uniform() < 0.2 ? 0.0 : rng.Uniform();
    shares[0] += 1e-3;
    const int total = static_cast<int>(rng.IntegerBelow(1000));
    const std::vector<int> counts = SplitByShares(total, shares);
    ASSERT_EQ(counts.size(), shares.size());
    ASSERT_EQ(std::accumulate(counts.begin(), counts.end(), 0), total);
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (size_t i = 0; i < shares.size(); ++i) {
      ASSERT_LT(std::abs(counts[i] - total * shares[i] / sum), 1.0 + 1e-9);
      ASSERT_TRUE(shares[i] > 0.0 || counts[i] == 0);
    }
  }
}

}  // namespace
}  // namespace rcme
