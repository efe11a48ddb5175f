#include "stats/moments.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "stats/random.h"

namespace rcme {
namespace {

Moments ComputeMoments(const std::vector<double>& numbers) {
  Moments moments;
  for (const double x : numbers) moments.Add(x);
  return moments;
}

TEST(Moments, KnownAnswers) {
  // Mean 5, sum of squares 32 (by hand).
  const Moments moments = ComputeMoments({2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_EQ(moments.n(), 8);
  EXPECT_DOUBLE_EQ(moments.mean(), 5.0);
  EXPECT_DOUBLE_EQ(moments.variance(), 32.0 / 7.0);
  EXPECT_DOUBLE_EQ(moments.standard_error(), std::sqrt(32.0 / 7.0 / 8.0));
}

TEST(Moments, KeepsItsDigitsFarFromZero) {
  // The textbook sum of x^2 - n mean^2 has none left here. NIST StRD, "NumAcc4": mean 10000000.2, standard
  // deviation 0.1 (1001 numbers 10000000.2, then 10000000.1 and 10000000.3 in turn).
  Moments moments;
  moments.Add(10000000.2);
  for (int i = 0; i < 500; ++i) {
    moments.Add(10000000.1);
    moments.Add(10000000.3);
  }
  EXPECT_NEAR(moments.mean(), 10000000.2, 1e-8);
  EXPECT_NEAR(std::sqrt(moments.variance()), 0.1, 1e-8);  // the inputs themselves are rounded to 1e-9
}

TEST(Moments, AgreesWithTwoPasses) {
  RandomStream rng({.seed = 1, .purpose = 20});
  std::vector<double> numbers(1000);
  long double sum = 0.0L, squares = 0.0L;
  for (double& x : numbers) sum += x = 3.0 + 0.2 * rng.Normal();
  const long double mean = sum / 1000.0L;
  for (const double x : numbers) squares += (x - mean) * (x - mean);
  const Moments moments = ComputeMoments(numbers);
  EXPECT_NEAR(moments.mean(), static_cast<double>(mean), 1e-14);
  EXPECT_NEAR(moments.variance(), static_cast<double>(squares / 999.0L), 1e-14);
}

TEST(Moments, TooFewNumbersAreNan) {
  EXPECT_EQ(Moments().n(), 0);
  EXPECT_TRUE(std::isnan(Moments().mean()));
  EXPECT_TRUE(std::isnan(Moments().variance()));
  EXPECT_TRUE(std::isnan(Moments().standard_error()));
  const Moments one = ComputeMoments({3.0});
  EXPECT_EQ(one.mean(), 3.0);
  EXPECT_TRUE(std::isnan(one.variance()));
  EXPECT_TRUE(std::isnan(one.standard_error()));
  EXPECT_EQ(ComputeMoments({3.0, 3.0}).variance(), 0.0);
}

TEST(Moments, InfiniteNumbersMakeTheMeanInfiniteWhereverTheyStand) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& numbers :
       {std::vector<double>{kInf}, {kInf, 1, 2}, {1, kInf, 2}, {1, 2, kInf}, {kInf, 1, kInf, kInf}}) {
    const Moments moments = ComputeMoments(numbers);
    EXPECT_EQ(moments.mean(), kInf);
    EXPECT_TRUE(std::isnan(moments.variance()));
    EXPECT_TRUE(std::isnan(moments.standard_error()));
    Moments before = ComputeMoments({3.0, 4.0}), after = moments, both = moments;
    before.Merge(moments);
    after.Merge(ComputeMoments({3.0, 4.0}));
    both.Merge(moments);
    for (const Moments& merged : {before, after, both}) {
      EXPECT_EQ(merged.mean(), kInf);
      EXPECT_TRUE(std::isnan(merged.variance()));
    }
  }
  EXPECT_EQ(ComputeMoments({1.0, -kInf, 2.0}).mean(), -kInf);
  EXPECT_TRUE(std::isnan(ComputeMoments({-kInf, 1.0, kInf, 2.0}).mean()));
}

TEST(Moments, MergedPartsEqualOnePass) {
  // Parts of very different size and mean: without Chan's cross term the variance would be 100 times too
  // small.
  RandomStream rng({.seed = 1, .purpose = 21});
  for (const size_t split : {size_t{0}, size_t{1}, size_t{3}, size_t{500}, size_t{1000}}) {
    std::vector<double> numbers(1000);
    for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = (i < split ? 1e3 : 1.0) + rng.Normal();
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(split);
    Moments merged = ComputeMoments({numbers.begin(), middle});
    merged.Merge(ComputeMoments({middle, numbers.end()}));
    const Moments whole = ComputeMoments(numbers);
    EXPECT_EQ(merged.n(), 1000);
    EXPECT_NEAR(merged.mean(), whole.mean(), 1e-12 * whole.mean());
    EXPECT_NEAR(merged.variance(), whole.variance(), 1e-12 * whole.variance());
  }
}

}  // namespace
}  // namespace rcme
