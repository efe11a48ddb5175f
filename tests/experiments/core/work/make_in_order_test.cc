#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "experiments/core/work/for_each_index.h"

namespace rcme {
namespace {

class MakeInOrderTest : public testing::TestWithParam<int> {};

TEST_P(MakeInOrderTest, TakesEveryValueInItsOrderHoweverLongItTook) {
  std::vector<std::int64_t> taken, expected(300);
  std::iota(expected.begin(), expected.end(), 0);
  const auto make = [](std::int64_t i) {
    if (i % 7 == 0) std::this_thread::sleep_for(std::chrono::microseconds(300));
    return i;
  };
  MakeInOrder(300, GetParam(), make, [&](std::int64_t i) { taken.push_back(i); });
  EXPECT_EQ(taken, expected);
}

TEST_P(MakeInOrderTest, AnErrorEndsItAfterTheValuesBefore) {
  std::vector<int> taken;
  const auto make = [](std::int64_t i) {
    if (i == 20) throw std::runtime_error("no such file");
    return static_cast<int>(i);
  };
  EXPECT_THROW(MakeInOrder(1000, GetParam(), make, [&](int i) { taken.push_back(i); }), std::runtime_error);
  ASSERT_EQ(taken.size(), 20u);
  for (size_t i = 0; i < taken.size(); ++i) EXPECT_EQ(taken[i], static_cast<int>(i));
}

TEST_P(MakeInOrderTest, AnErrorOfTakingEndsIt) {
  int num_taken = 0;
  const auto take = [&](std::int64_t i) {
    if (i == 20) throw std::runtime_error("the disk is full");
    ++num_taken;
  };
  EXPECT_THROW(MakeInOrder(
                   1000, GetParam(), [](std::int64_t i) { return i; }, take),
               std::runtime_error);
  EXPECT_EQ(num_taken, 20);
}

// The first takes longer than all others together would: they wait for it.
TEST_P(MakeInOrderTest, HoldsNoMoreThanAFewValues) {
  std::atomic<std::int64_t> furthest = 0;
  std::int64_t furthest_of_first = 0;
  const auto make = [&](std::int64_t i) {
    if (i == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
      furthest_of_first = furthest;
    }
    for (std::int64_t seen = furthest; seen < i && !furthest.compare_exchange_weak(seen, i);) {
    }
    return i;
  };
  MakeInOrder(10'000, GetParam(), make, [](std::int64_t) {});
  EXPECT_LE(furthest_of_first, 16 * GetParam() + GetParam());
}

// Those that are far ahead of the first wait for it: they do not wait for ever.
TEST_P(MakeInOrderTest, AnErrorEndsThoseThatWait) {
  const auto make = [](std::int64_t i) {
    if (i > 0) return i;
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    throw std::runtime_error("no such file");
  };
  EXPECT_THROW(MakeInOrder(10'000, GetParam(), make, [](std::int64_t) {}), std::runtime_error);
}

INSTANTIATE_TEST_SUITE_P(Threads, MakeInOrderTest, testing::Values(1, 2, 8));

TEST(MakeInOrder, NothingIsMadeOfNothing) {
  MakeInOrder(
      0, 2, [](std::int64_t i) { return i; }, [](std::int64_t) { FAIL(); });
}

}  // namespace
}  // namespace rcme
