// The capital against its definition, with the C library's log1p; the same bits on every instruction set.
#include "stats/betting.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "stats/random.h"

namespace rcme {
namespace {

constexpr std::array<double, 14> kStakes = {0.95, 0.85, 0.7,  0.55, 0.4,   0.28,   0.2,
                                            0.14, 0.1,  0.07, 0.05, 0.025, 0.0125, 0.00625};

std::vector<CountedNumber> DrawNumbers(std::uint32_t trial) {
  RandomStream rng({.seed = 3, .trial = trial, .purpose = 91});
  std::vector<CountedNumber> numbers;
  for (int i = 0; i < 25; ++i) numbers.push_back({rng.Uniform(), 10.0 * rng.Uniform()});
  return numbers;
}

double LogCapitalByDefinition(const std::vector<CountedNumber>& numbers, double m) {
  double capital = 0.0;
  for (const double stake : kStakes) {
    double sum = 0.0;
    for (const CountedNumber& number : numbers) sum += number.count * std::log1p(stake / m * (number.x - m));
    capital += std::exp(sum);
  }
  return std::log(capital / static_cast<double>(kStakes.size()));
}

TEST(Betting, CapitalIsThatOfItsDefinition) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const std::vector<CountedNumber> numbers = DrawNumbers(trial);
    for (const double m : {0.05, 0.3, 0.5, 0.8}) {
      const double expected = LogCapitalByDefinition(numbers, m);
      const double capital = LogCapital(numbers, m, kStakes, 1.0 / m);
      EXPECT_NEAR(capital, expected, 1e-12 * (1.0 + std::abs(expected))) << m;
      for (const double less : {1e-9, 1e-3, 1.0, 5.0}) {
        EXPECT_TRUE(IsCapitalAtLeast(capital - less, numbers, m, kStakes, 1.0 / m));
        EXPECT_FALSE(IsCapitalAtLeast(capital + less, numbers, m, kStakes, 1.0 / m));
      }
    }
  }
}

TEST(Betting, TheSameBitsOnEveryInstructionSet) {
  const std::vector<CountedNumber> numbers = DrawNumbers(0);
  const double expected = LogCapital(numbers, 0.4, kStakes, 2.5);
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    hwy::SetSupportedTargetsForTest(targets & -targets);
    EXPECT_EQ(LogCapital(numbers, 0.4, kStakes, 2.5), expected) << hwy::TargetName(targets & -targets);
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(Betting, RefusesNoStakesAndTooMany) {
  const std::vector<double> many(17, 0.1);
  EXPECT_THROW(LogCapital({{0.5, 1.0}}, 0.5, {}), std::invalid_argument);
  EXPECT_THROW(LogCapital({{0.5, 1.0}}, 0.5, many), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
