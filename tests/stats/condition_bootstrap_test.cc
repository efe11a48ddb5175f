#include "stats/condition_bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "stats/moments.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

double MeanOverTimes(const std::vector<double>& numbers, std::span<const int> times) {
  double sum = 0.0;
  for (size_t i = 0; i < numbers.size(); ++i) sum += times[i] * numbers[i];
  return sum / static_cast<double>(numbers.size());
}

constexpr Interval kAnywhere = {-1e9, 1e9};

// Of a mean the bootstrap's standard error has the limit s / sqrt(n) with the correction for few conditions:
// 20,000 samples give it to half a per cent (standard deviation), and the test allows four of these.
TEST(ConditionBootstrap, StandardErrorOfAMean) {
  const std::vector<double> numbers = {1.0, 4.0, 2.0, 8.0, 5.0, 7.0};
  Moments moments;
  for (const double x : numbers) moments.Add(x);
  RandomStream rng({.seed = 1, .purpose = 485});
  const ConditionStatistic mean = [&](std::span<const int> times) { return MeanOverTimes(numbers, times); };
  const BootstrapEstimate estimate =
      BootstrapOverConditions(numbers.size(), mean, {.num_samples = 20'000, .range = kAnywhere}, rng);
  EXPECT_NEAR(estimate.value, 4.5, 1e-15);
  EXPECT_NEAR(estimate.standard_error / moments.standard_error(), 1.0, 0.02);
  EXPECT_NEAR(estimate.bias, 0.0, 4.0 * moments.standard_error() / std::sqrt(20'000.0));
  const Interval student = StudentInterval(moments);
  EXPECT_NEAR(estimate.interval.upper / student.upper, 1.0, 0.02);
}

TEST(ConditionBootstrap, SameStreamSameSamples) {
  const ConditionStatistic first = [](std::span<const int> times) { return 0.1 * times[0]; };
  RandomStream a({.seed = 3, .purpose = 486}), b({.seed = 3, .purpose = 486});
  const BootstrapEstimate x = BootstrapOverConditions(9, first, {}, a),
                          y = BootstrapOverConditions(9, first, {}, b);
  EXPECT_EQ(x.standard_error, y.standard_error);
  EXPECT_EQ(x.interval.upper, y.interval.upper);
}

TEST(ConditionBootstrap, FewOrUndefined) {
  RandomStream rng({.seed = 1, .purpose = 487});
  const ConditionStatistic half = [](std::span<const int>) { return 0.5; };
  const BootstrapEstimate one = BootstrapOverConditions(1, half, {}, rng);
  EXPECT_EQ(one.interval.lower, 0.0);
  EXPECT_EQ(one.interval.upper, 1.0);
  // Undefined where the first of three conditions was not drawn. Otherwise it is drawn once, twice or three
  // times with probability 12, 6 and 1 of 19, so the mean of 1 / times is (12 + 3 + 1/3) / 19.
  const ConditionStatistic of_first = [](std::span<const int> times) {
    return times[0] > 0 ? 1.0 / times[0] : std::nan("");
  };
  const BootstrapEstimate some = BootstrapOverConditions(3, of_first, {.num_samples = 5000}, rng);
  EXPECT_NEAR(some.value + some.bias, 46.0 / 57.0, 4.0 * some.standard_error / std::sqrt(3500.0));
  EXPECT_THROW(BootstrapOverConditions(0, half, {}, rng), std::invalid_argument);
  EXPECT_THROW(BootstrapOverConditions(3, half, {.num_samples = 1}, rng), std::invalid_argument);
}

// |mean| of 12 normal numbers of mean 0: the truth is 0, and only the allowance for chance reaches it. 1,000
// repetitions.
TEST(ConditionBootstrap, AllowsForWhatChanceAdds) {
  RandomStream rng({.seed = 1, .purpose = 488});
  CoverageCount covered, plain;
  for (int repetition = 0; repetition < 1000; ++repetition) {
    std::vector<std::vector<double>> columns(4, std::vector<double>(12));
    for (std::vector<double>& column : columns) {
      for (double& x : column) x = rng.Normal();
    }
    const ConditionStatistic distance = [&](std::span<const int> times) {
      double sum = 0.0;
      for (const std::vector<double>& column : columns) sum += std::abs(MeanOverTimes(column, times));
      return sum;
    };
    BootstrapOptions options{.num_samples = 200, .chance_bias = ChanceBias::kUpwards, .range = {0.0, 1e9}};
    covered.Add(BootstrapOverConditions(12, distance, options, rng).interval.Contains(0.0));
    options.chance_bias = ChanceBias::kNone;
    plain.Add(BootstrapOverConditions(12, distance, options, rng).interval.Contains(0.0));
  }
  EXPECT_GT(covered.interval().upper, 0.93) << covered;
  EXPECT_LT(plain.interval().upper, 0.7) << plain;
}

}  // namespace
}  // namespace rcme
