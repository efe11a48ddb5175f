#include "stats/sparsification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "stats/condition_bootstrap.h"
#include "stats/constants.h"
#include "stats/moments.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

constexpr double kPi = 3.141592653589793;

// By all orders of the ties:  /usr/bin/python3 tests/known_answers/forecasts.py
TEST(Sparsification, KnownAnswer) {
  const std::vector<StatedError> errors = {{2, 3, 0}, {1, 1, 1}, {4, 2, 2}, {4, 9, 3},
                                           {3, 1, 4}, {1, 4, 5}, {7, 6, 6}, {5, 5, 7}};
  const Sparsification measured = MeasureSparsification(errors);
  EXPECT_NEAR(measured.ause.value, 0.213824884793, 1e-12);
  EXPECT_NEAR(measured.ause_random.value, 0.452649769585, 1e-12);
  EXPECT_EQ(measured.ause.n, 8);
  EXPECT_EQ(measured.ause.num_clusters, 8);
}

// The two curves as they are defined, point by point.
TEST(Sparsification, IsTheAreaBetweenTheCurves) {
  RandomStream rng({.seed = 1, .purpose = 520});
  std::vector<StatedError> errors;
  double sum = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double stated = rng.Uniform();
    errors.push_back({stated, stated * -std::log(rng.Uniform()), i});
    sum += errors.back().error;
  }
  const auto area = [&](double StatedError::*key) {
    std::vector<StatedError> sorted = errors;
    std::ranges::sort(sorted, {}, key);
    double of_first = 0.0, total = 0.0;
    for (size_t k = 0; k < sorted.size(); ++k) {
      of_first += sorted[k].error;
      total += of_first / static_cast<double>(k + 1) / 300.0;
    }
    return total;
  };
  const double oracle = area(&StatedError::error);
  const Sparsification measured = MeasureSparsification(errors);
  EXPECT_NEAR(measured.ause.value, (area(&StatedError::stated) - oracle) / (sum / 300.0), 1e-12);
  EXPECT_NEAR(measured.ause_random.value, 1.0 - oracle / (sum / 300.0), 1e-12);
}

// Closed forms, of a sample of 400, in clusters of which all errors are equal or not.
//   exponential errors, a random order: E[e (-log F(e))] = 2 - pi^2 / 6, so that both are pi^2 / 6 - 1
//   uniform errors, stated as they are in half of the cases, else at random: (3/8 - 1/4) / (1/2) = 1/4, and
//   1/2
// 2,000 repetitions: the intervals cover, the standard errors are the spread to 8 %.
TEST(Sparsification, CoversClosedForms) {
  const auto exponential = [](RandomStream& rng) {
    return StatedError{rng.Uniform(), -std::log(rng.Uniform()), 0};
  };
  const auto half_known = [](RandomStream& rng) {
    const double error = rng.Uniform(), other = rng.Uniform();
    return StatedError{rng.Uniform() < 0.5 ? error : other, error, 0};
  };
  const struct {
    StatedError (*draw)(RandomStream&);
    double ause, ause_random;
    int copies;
  } kCases[] = {{exponential, kPi * kPi / 6.0 - 1.0, kPi * kPi / 6.0 - 1.0, 1},
                {half_known, 0.25, 0.5, 1},
                {half_known, 0.25, 0.5, 4}};
  for (std::uint32_t c = 0; c < std::size(kCases); ++c) {
    RandomStream rng({.seed = 1, .condition = c, .purpose = 521});
    CoverageCount covered, random_covered;
    Moments areas, standard_errors, random_areas;
    for (int repetition = 0; repetition < 2000; ++repetition) {
      std::vector<StatedError> errors;
      for (int i = 0; i < 400; ++i) {
        StatedError error = kCases[c].draw(rng);
        error.cluster = i;
        errors.insert(errors.end(), static_cast<size_t>(kCases[c].copies), error);
      }
      const Sparsification measured = MeasureSparsification(errors);
      covered.Add(measured.ause.interval.Contains(kCases[c].ause));
      random_covered.Add(measured.ause_random.interval.Contains(kCases[c].ause_random));
      areas.Add(measured.ause.value);
      random_areas.Add(measured.ause_random.value);
      standard_errors.Add(measured.ause.standard_error);
    }
    const double spread = std::sqrt(areas.variance());
    for (const CoverageCount& count : {covered, random_covered}) {
      EXPECT_GT(count.interval().upper, 0.95) << c << ": " << count;
      EXPECT_GT(count.rate(), 0.93) << c << ": " << count;
    }
    EXPECT_NEAR(areas.mean(), kCases[c].ause, 4.0 * areas.standard_error() + 0.003) << c;
    EXPECT_NEAR(random_areas.mean(), kCases[c].ause_random, 4.0 * random_areas.standard_error() + 0.003) << c;
    EXPECT_NEAR(standard_errors.mean(), spread, 0.08 * spread) << c;
  }
}

// Conditions of different difficulty, whose trials are alike: the standard error is that of the bootstrap
// which draws whole conditions. As if all trials were independent it would be a third of it.
TEST(Sparsification, ErrsAsTheBootstrapOverConditions) {
  constexpr int kConditions = 60, kTrials = 20;
  RandomStream rng({.seed = 1, .purpose = 522});
  std::vector<std::vector<StatedError>> conditions(kConditions);
  std::vector<StatedError> all;
  for (int c = 0; c < kConditions; ++c) {
    const double scale = 0.2 + rng.Uniform(), stated = scale * (0.5 + rng.Uniform());
    for (int i = 0; i < kTrials; ++i)
      conditions[static_cast<size_t>(c)].push_back(
          {stated * (0.9 + 0.2 * rng.Uniform()), -scale * std::log(rng.Uniform()), c});
    all.insert(all.end(), conditions[static_cast<size_t>(c)].begin(),
               conditions[static_cast<size_t>(c)].end());
  }
  const ConditionStatistic statistic = [&](std::span<const int> times) {
    std::vector<StatedError> drawn;
    for (size_t c = 0; c < times.size(); ++c)
      for (int k = 0; k < times[c]; ++k)
        drawn.insert(drawn.end(), conditions[c].begin(), conditions[c].end());
    return MeasureSparsification(drawn).ause.value;
  };
  RandomStream samples({.seed = 1, .purpose = 523});
  const BootstrapEstimate bootstrap = BootstrapOverConditions(kConditions, statistic, {}, samples);
  const ClusteredEstimate measured = MeasureSparsification(all).ause;
  EXPECT_NEAR(measured.standard_error / bootstrap.standard_error, 1.0, 0.1);
  for (size_t i = 0; i < all.size(); ++i) all[i].cluster = static_cast<std::int64_t>(i);
  EXPECT_LT(MeasureSparsification(all).ause.standard_error, 0.6 * measured.standard_error);
}

TEST(Sparsification, EndsOfTheMatter) {
  std::vector<StatedError> errors;
  for (int i = 1; i <= 50; ++i) errors.push_back({0.1 * i, 2.0 * i, i});
  EXPECT_EQ(MeasureSparsification(errors).ause.value, 0.0);  // the oracle's order
  EXPECT_EQ(MeasureSparsification(errors).ause.interval.lower, 0.0);
  for (StatedError& error : errors) error.stated = 1.0;  // which says nothing
  const Sparsification none = MeasureSparsification(errors);
  EXPECT_NEAR(none.ause.value, none.ause_random.value, 1e-12);
  for (StatedError& error : errors) error.error = 0.0;
  EXPECT_TRUE(std::isnan(MeasureSparsification(errors).ause.value));
  EXPECT_THROW(MeasureSparsification({}), std::invalid_argument);
  for (const StatedError& wrong :
       {StatedError{1.0, -1.0, 0}, StatedError{kNaN, 1.0, 0}, StatedError{1.0, kInfinity, 0}})
    EXPECT_THROW(MeasureSparsification(std::vector{wrong}), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
