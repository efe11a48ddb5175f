#include "experiments/core/work/read_ahead.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>

namespace rcme {
namespace {

// Gives 0, 1, ..., n - 1.
class Numbers {
 public:
  explicit Numbers(int n) : n_(n) {}
  bool operator()(int* item) {
    if (next_ == n_) return false;
    *item = next_++;
    return true;
  }

 private:
  int n_, next_ = 0;
};

class ReadAheadTest : public testing::TestWithParam<int> {};

TEST_P(ReadAheadTest, VisitsEveryItemOnceInItsOrder) {
  std::vector<int> visited, expected(static_cast<size_t>(GetParam()));
  std::iota(expected.begin(), expected.end(), 0);
  ReadAhead<int>(Numbers(GetParam()), [&](int item) { visited.push_back(item); });
  EXPECT_EQ(visited, expected);
}

TEST_P(ReadAheadTest, AnErrorOfReadingComesAfterTheItemsBefore) {
  int num_visited = 0, num_read = 0;
  const auto read = [&](int* item) {
    *item = num_read;
    if (num_read++ == GetParam()) throw std::runtime_error("damaged");
    return true;
  };
  EXPECT_THROW(ReadAhead<int>(read, [&](int) { ++num_visited; }), std::runtime_error);
  EXPECT_EQ(num_visited, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Sizes, ReadAheadTest, testing::Values(0, 1, 199, 200, 201, 800, 5000));

TEST(ReadAhead, AnErrorOfAVisitEndsTheReading) {
  std::atomic<int> num_read = 0;
  const auto read = [&](int* item) {
    *item = num_read++;
    return true;  // without end
  };
  EXPECT_THROW(ReadAhead<int>(read,
                              [](int item) {
                                if (item == 700) throw std::logic_error("enough");
                              }),
               std::logic_error);
  EXPECT_LE(num_read, 700 + 200 * 7);
}

}  // namespace
}  // namespace rcme
