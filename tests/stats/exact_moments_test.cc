#include "stats/exact_moments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "stats/constants.h"
#include "stats/moments.h"

namespace rcme {
namespace {

template <typename Stream>
Stream StreamFrom(const std::vector<double>& numbers) {
  Stream stream;
  for (const double x : numbers) stream.Add(x);
  return stream;
}

std::vector<double> Spread(int n) {
  std::mt19937_64 random(7);
  std::vector<double> numbers;
  for (int i = 0; i < n; ++i) {
    const double mantissa = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
    numbers.push_back(std::ldexp(mantissa, std::uniform_int_distribution<int>(-200, 200)(random)));
  }
  return numbers;
}

TEST(ExactMoments, LosesNothing) {
  EXPECT_EQ(StreamFrom<ExactMoments>({1e100, 1.0, -1e100, 2.0}).mean(), 0.75);
  EXPECT_EQ(StreamFrom<ExactMoments>({1e15 + 1.0, 1e15 + 2.0, 1e15 + 3.0}).variance(), 1.0);
  EXPECT_EQ(StreamFrom<ExactMoments>({0.1, 0.1, 0.1}).mean(), 0.1);
  EXPECT_EQ(StreamFrom<ExactMoments>({0.1, 0.1, 0.1}).variance(), 0.0);
  constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(StreamFrom<ExactMoments>({kSmallest, kSmallest}).mean(), kSmallest);
  EXPECT_EQ(StreamFrom<ExactMoments>({-3.0, -3.0, 3.0}).mean(), -1.0);
}

TEST(ExactMoments, AgreeWithWelford) {
  std::mt19937_64 random(1);
  std::vector<double> numbers;
  for (int i = 0; i < 10'000; ++i) numbers.push_back(std::normal_distribution<double>(3.0, 2.0)(random));
  const ExactMoments exact = StreamFrom<ExactMoments>(numbers);
  const Moments moments = StreamFrom<Moments>(numbers);
  EXPECT_EQ(exact.n(), moments.n());
  EXPECT_NEAR(exact.mean(), moments.mean(), 1e-13);
  EXPECT_NEAR(exact.variance(), moments.variance(), 1e-12);
  EXPECT_NEAR(exact.standard_error(), moments.standard_error(), 1e-14);
}

TEST(ExactMoments, DoNotDependOnOrderAndGroups) {
  std::vector<double> numbers = Spread(500);
  const ExactMoments whole = StreamFrom<ExactMoments>(numbers);
  std::ranges::reverse(numbers);
  EXPECT_EQ(StreamFrom<ExactMoments>(numbers).Texts(), whole.Texts());
  ExactMoments merged;
  for (size_t first = 0; first < numbers.size(); first += 77) {
    const size_t end = std::min(first + 77, numbers.size());
    const auto at = [&](size_t i) { return numbers.begin() + static_cast<std::ptrdiff_t>(i); };
    merged.Merge(ExactMoments::FromTexts(StreamFrom<ExactMoments>({at(first), at(end)}).Texts()));
  }
  EXPECT_EQ(merged.Texts(), whole.Texts());
  EXPECT_EQ(merged.mean(), whole.mean());
  EXPECT_EQ(merged.variance(), whole.variance());
}

TEST(ExactMoments, NotEnoughAndInfiniteNumbers) {
  EXPECT_TRUE(std::isnan(ExactMoments().mean()));
  EXPECT_TRUE(std::isnan(StreamFrom<ExactMoments>({1.0}).variance()));
  EXPECT_EQ(StreamFrom<ExactMoments>({1.0, kInfinity}).mean(), kInfinity);
  EXPECT_TRUE(std::isnan(StreamFrom<ExactMoments>({1.0, kInfinity}).variance()));
  EXPECT_EQ(StreamFrom<ExactMoments>({1.0, -kInfinity}).mean(), -kInfinity);
  EXPECT_TRUE(std::isnan(StreamFrom<ExactMoments>({kInfinity, -kInfinity}).mean()));
  EXPECT_EQ(ExactMoments::FromTexts(StreamFrom<ExactMoments>({1.0, kInfinity}).Texts()).mean(), kInfinity);
  EXPECT_THROW(ExactMoments().Add(std::nan("")), std::invalid_argument);
}

TEST(ExactMoments, TextsOfOthersAreRefused) {
  using Texts = std::vector<std::string>;
  for (const Texts& texts :
       {Texts{}, Texts{"1", "0"}, Texts{"-1", "0", "0"}, Texts{"x", "0", "0"}, Texts{"1", "1", "0"},
        Texts{"1", "p3", "0"}, Texts{"1", "1gp3", "0"}, Texts{"1", "1p-2000", "0"},
        Texts{"1", "1p99999", "0"}, Texts{"1", "1p2147483647", "0"}, Texts{"1", "1p", "0"},
        Texts{"1", "fffffffffp2170", "0"}})
    EXPECT_THROW(ExactMoments::FromTexts(texts), std::invalid_argument) << testing::PrintToString(texts);
  EXPECT_EQ(ExactMoments::FromTexts({"2", "-3p-1", "9p-2"}).mean(), -0.75);
}

}  // namespace
}  // namespace rcme
