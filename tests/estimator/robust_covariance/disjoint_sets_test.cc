#include "estimator/robust_covariance/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "stats/random.h"

namespace rcme {
namespace {

TEST(DisjointSets, AreNumberedByTheirFirstMembers) {
  DisjointSets sets(6);
  EXPECT_EQ(sets.Numbers(), (std::vector<int>{0, 1, 2, 3, 4, 5}));
  sets.Unite(5, 1);
  sets.Unite(4, 5);
  EXPECT_EQ(sets.Numbers(), (std::vector<int>{0, 1, 2, 3, 1, 1}));
  // A set takes all of its members along, whichever of them is named.
  sets.Unite(1, 0);
  EXPECT_EQ(sets.Numbers(), (std::vector<int>{0, 0, 1, 2, 0, 0}));
  EXPECT_EQ(DisjointSets(0).Numbers(), std::vector<int>());
}

// Against labels that are all written anew at each union.
TEST(DisjointSets, AreThoseOfLabels) {
  constexpr size_t kSize = 40;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 74});
    DisjointSets sets(kSize);
    std::vector<size_t> label(kSize);
    std::iota(label.begin(), label.end(), size_t{0});
    for (int k = 0; k < 30; ++k) {
      const size_t a = rng.IntegerBelow(kSize), b = rng.IntegerBelow(kSize);
      sets.Unite(a, b);
      std::ranges::replace(label, size_t{label[a]}, size_t{label[b]});
    }
    for (size_t i = 0; i < kSize; ++i) {
      for (size_t k = 0; k < kSize; ++k) ASSERT_EQ(sets.Find(i) == sets.Find(k), label[i] == label[k]);
    }
  }
}

}  // namespace
}  // namespace rcme
