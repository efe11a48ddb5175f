#include "stats/bounded_mean.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "stats/confidence_sequence.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

TEST(BoundedMean, CountsANumberAsTheMiddleOfItsBin) {
  BoundedMean tally;
  EXPECT_TRUE(std::isnan(tally.mean()));
  EXPECT_EQ(tally.Sequence().lower, 0.0);
  EXPECT_EQ(tally.Sequence().upper, 1.0);
  tally.Add(0.0), tally.Add(0.5), tally.Add(1.0);
  EXPECT_EQ(tally.n(), 3);
  EXPECT_DOUBLE_EQ(tally.mean(), (0.5 + 64.5 + 127.5) / 128.0 / 3.0);
  for (const double bad : {-1e-9, 1.0 + 1e-9, std::nan("")}) {
    EXPECT_THROW(tally.Add(bad), std::invalid_argument);
  }
}

// The capital by its definition, number by number: it reaches 1 / a at the lower bound and not above it.
TEST(BoundedMean, TheLowerBoundIsWhereTheCapitalReachesOneOverA) {
  constexpr double kConfidence = 0.9, kNeeded = 2.0 / (1.0 - kConfidence);
  BoundedMean tally;
  std::vector<double> numbers;
  RandomStream rng({1, 2, 3, 0});
  for (int i = 0; i < 200; ++i) {
    const double x = std::pow(rng.Uniform(), 0.25);
    tally.Add(x);
    numbers.push_back((std::floor(128.0 * x) + 0.5) / 128.0);
  }
  const auto capital = [&](double m, double sign) {
    double sum = 0.0;
    for (double stake = 1.0; stake > 1.0 / 200.0; stake *= 0.5) {
      double product = 1.0;
      for (const double x : numbers) product *= 1.0 + stake * sign * (x - m);
      sum += product / 8.0;
    }
    return sum;
  };
  const Interval bounds = tally.Sequence(kConfidence);
  EXPECT_GE(capital(bounds.lower, 1.0), kNeeded);
  EXPECT_LT(capital(bounds.lower + 1e-3 * (bounds.upper - bounds.lower), 1.0), kNeeded);
  EXPECT_GE(capital(bounds.upper, -1.0), kNeeded);
  EXPECT_LT(capital(bounds.upper - 1e-3 * (bounds.upper - bounds.lower), -1.0), kNeeded);
}

// Looked at again and again, the intervals of a sequence all hold the mean in at least 1 - alpha of the
// sequences, for laws with and without skewness. (Student's interval, looked at so, misses in a third.)
TEST(BoundedMean, HoldsAtAllSampleSizesAtOnce) {
  struct Law {
    const char* name;
    double mean;
    std::function<double(RandomStream&)> draw;
  };
  const auto middle = [](double x) {
    return BoundedMean::MiddleOf(std::min(static_cast<int>(128.0 * x), 127));
  };
  double mean_of_square = 0.0;  // of the middle of u^2's bin
  for (int b = 0; b < 128; ++b) {
    mean_of_square += middle((b + 0.5) / 128.0) * (std::sqrt((b + 1) / 128.0) - std::sqrt(b / 128.0));
  }
  const std::vector<Law> laws = {
      {"uniform", 0.5, [](RandomStream& rng) { return rng.Uniform(); }},
      {"square", mean_of_square, [](RandomStream& rng) { return std::pow(rng.Uniform(), 2.0); }},
      {"1 in 20", middle(0.0) + 0.05 * (middle(1.0) - middle(0.0)),
       [](RandomStream& rng) { return rng.Uniform() < 0.05 ? 1.0 : 0.0; }}};
  for (const Law& law : laws) {
    CoverageCount holds;
    for (std::uint32_t sequence = 0; sequence < 100; ++sequence) {
      RandomStream rng({1, 7, sequence, 0});
      BoundedMean tally;
      bool holds_so_far = true;
      for (int n = 1; n <= 300 && holds_so_far; ++n) {
        tally.Add(law.draw(rng));
        if (n % (1 + n / 15) != 0) continue;
        holds_so_far = tally.Sequence(0.9).Contains(law.mean);
      }
      holds.Add(holds_so_far);
    }
    EXPECT_GE(holds.rate(), 0.9) << law.name << ": " << holds;
  }
}

// What a mean of uniform numbers costs: 5.3 standard errors at the confidence of an audit, where one look at
// fixed n takes 4; and far less than counts with as much scatter as a coin's.
TEST(BoundedMean, IsNarrowerTheLessTheNumbersScatter) {
  constexpr double kConfidence = 1.0 - 6e-5;
  constexpr int kNumbers = 20'000;
  BoundedMean uniform, narrow, coin;
  for (int b = 0; b < BoundedMean::kNumBins; ++b) uniform.AddToBin(b, kNumbers / 128.0);
  for (int b = 56; b < 72; ++b) narrow.AddToBin(b, kNumbers / 16.0);
  coin.AddToBin(0, kNumbers / 2), coin.AddToBin(127, kNumbers / 2);
  const auto width = [](const BoundedMean& tally) {
    return tally.Sequence(kConfidence).upper - tally.mean();
  };
  EXPECT_LT(width(uniform), 5.4 * uniform.standard_deviation() / std::sqrt(kNumbers));
  EXPECT_GT(width(uniform), 4.0 * uniform.standard_deviation() / std::sqrt(kNumbers));
  EXPECT_LT(width(narrow), 0.25 * width(uniform));
  EXPECT_LT(width(coin), 1.1 * (ConfidenceSequence(kNumbers / 2, kNumbers, kConfidence).upper - 0.5));
}

}  // namespace
}  // namespace rcme
