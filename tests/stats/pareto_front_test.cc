#include "stats/pareto_front.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace rcme {
namespace {

using Indices = std::vector<size_t>;

// By the definition: point by point against every other.
Indices FrontByDefinition(const std::vector<double>& x, const std::vector<double>& y, TiesOfFirst ties) {
  Indices front;
  for (size_t i = 0; i < x.size(); ++i) {
    bool is_beaten = false;
    for (size_t j = 0; j < x.size(); ++j) {
      const bool is_lower_and_as_good = x[j] < x[i] && y[j] <= y[i];
      const bool is_tied_and_better = x[j] == x[i] && y[j] < y[i];
      is_beaten |= is_lower_and_as_good || (ties == TiesOfFirst::kLeastSecondStays && is_tied_and_better);
    }
    if (!is_beaten) front.push_back(i);
  }
  return front;
}

TEST(ParetoFront, TiesAndEquals) {
  const std::vector<double> x = {1, 1, 2, 2, 3, 3, 0}, y = {4, 5, 4, 3, 3, 1, 9};
  EXPECT_EQ(ParetoFront(x, y, TiesOfFirst::kLeastSecondStays), (Indices{6, 0, 3, 5}));
  EXPECT_EQ(ParetoFront(x, y, TiesOfFirst::kStay), (Indices{6, 0, 1, 3, 5}));
  EXPECT_EQ(ParetoFront({2, 2, 2}, {1, 1, 1}, TiesOfFirst::kLeastSecondStays), (Indices{0, 1, 2}));
}

TEST(ParetoFront, AsByItsDefinition) {
  std::mt19937 rng(1);
  for (int repetition = 0; repetition < 300; ++repetition) {
    std::vector<double> x, y;
    for (size_t i = 0; i < 1 + rng() % 12; ++i) {  // few values: ties and equals
      x.push_back(static_cast<double>(rng() % 5));
      y.push_back(static_cast<double>(rng() % 5));
    }
    for (const TiesOfFirst ties : {TiesOfFirst::kStay, TiesOfFirst::kLeastSecondStays}) {
      Indices front = ParetoFront(x, y, ties);
      EXPECT_TRUE(std::ranges::is_sorted(front, {}, [&](size_t i) { return x[i]; }));
      std::ranges::sort(front);
      EXPECT_EQ(front, FrontByDefinition(x, y, ties)) << repetition;
    }
  }
}

TEST(ParetoFront, InfinityIsAPointLikeOthers) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ParetoFront({infinity}, {infinity}, TiesOfFirst::kStay), Indices{0});
}

TEST(ParetoFront, NothingAndNonsense) {
  EXPECT_EQ(ParetoFront({}, {}, TiesOfFirst::kStay), Indices{});
  EXPECT_THROW(ParetoFront({1}, {}, TiesOfFirst::kStay), std::invalid_argument);
  EXPECT_THROW(ParetoFront({std::nan("")}, {1}, TiesOfFirst::kStay), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
