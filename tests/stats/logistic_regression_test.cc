#include "stats/logistic_regression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "stats/random.h"

namespace rcme {
namespace {

double Cost(const std::vector<double>& x, const std::vector<bool>& y, const LogisticFit& fit, double prior,
            double penalty) {
  double mean = 0.0;
  for (const double value : x) mean += value / static_cast<double>(x.size());
  const auto loss = [&](double value, double happened) {
    const double eta = fit.intercept + fit.weights[0] * value;
    return std::log1p(std::exp(eta)) - happened * eta;
  };
  double cost = 0.5 * loss(mean, 1.0) + 0.5 * loss(mean, 0.0);
  for (size_t i = 0; i < x.size(); ++i) cost += loss(x[i], y[i] ? 1.0 : 0.0);
  return cost + 0.5 * penalty * std::pow(fit.weights[0] - prior, 2);
}

// At the optimum no step is better, in any of the two directions.
TEST(FitLogistic, IsTheLeastOfItsCost) {
  RandomStream rng({.seed = 1, .purpose = 412});
  for (int repetition = 0; repetition < 50; ++repetition) {
    std::vector<double> x(40);
    std::vector<bool> y;
    for (double& value : x) {
      value = 2.0 * rng.Normal();
      y.push_back(rng.Uniform() < 1.0 / (1.0 + std::exp(1.0 - value)));
    }
    const double prior = 1.0, penalty = rng.Uniform(0.1, 5.0);
    const LogisticFit fit = FitLogistic(x, y, {&prior, 1}, penalty);
    const double least = Cost(x, y, fit, prior, penalty);
    for (const double step : {-1e-3, 1e-3}) {
      LogisticFit moved = fit;
      moved.intercept += step;
      EXPECT_GT(Cost(x, y, moved, prior, penalty), least);
      moved = fit;
      moved.weights[0] += step;
      EXPECT_GT(Cost(x, y, moved, prior, penalty), least);
    }
  }
}

// Without a feature the log odds of (k + 1/2) of (n + 1).
TEST(FitLogistic, InterceptAlone) {
  const std::vector<bool> y = {true, false, false, false, false, false, false, false, false};
  EXPECT_NEAR(FitLogistic({}, y, {}, 1.0).intercept, std::log(1.5 / 8.5), 1e-9);
  EXPECT_NEAR(FitLogistic({}, std::vector<bool>(99, false), {}, 1.0).intercept, std::log(0.5 / 99.5), 1e-6);
}

// 20,000 observations of two features: the weights that they were drawn with, within five standard errors.
TEST(FitLogistic, FindsWhatItWasDrawnWith) {
  RandomStream rng({.seed = 1, .purpose = 413});
  std::vector<double> features;
  std::vector<bool> y;
  for (int i = 0; i < 20000; ++i) {
    const double a = rng.Normal(), b = rng.Normal();
    features.insert(features.end(), {a, b});
    y.push_back(rng.Uniform() < 1.0 / (1.0 + std::exp(-(-1.0 + 0.7 * a - 1.2 * b))));
  }
  const std::vector<double> prior = {0.0, 0.0};
  const LogisticFit fit = FitLogistic(features, y, prior, 1e-3);
  EXPECT_NEAR(fit.intercept, -1.0, 0.1);
  EXPECT_NEAR(fit.weights[0], 0.7, 0.1);
  EXPECT_NEAR(fit.weights[1], -1.2, 0.12);
}

TEST(FitLogistic, StaysFiniteWhereEventsAreApart) {
  std::vector<double> x;
  std::vector<bool> y;
  for (int i = 0; i < 20; ++i) {
    x.push_back(i < 10 ? -1000.0 : 1000.0);
    y.push_back(i >= 10);
  }
  const double prior = 0.0;
  const LogisticFit fit = FitLogistic(x, y, {&prior, 1}, 1.0);
  EXPECT_TRUE(std::isfinite(fit.intercept) && std::isfinite(fit.weights[0]));
  EXPECT_GT(fit.weights[0], 0.0);
}

TEST(FitLogistic, RefusesWhatIsNone) {
  const double prior = 0.0, x = NAN;
  EXPECT_THROW(FitLogistic({}, {}, {}, 1.0), std::invalid_argument);
  EXPECT_THROW(FitLogistic({}, {true}, {&prior, 1}, 1.0), std::invalid_argument);
  EXPECT_THROW(FitLogistic({&x, 1}, {true}, {&prior, 1}, 1.0), std::invalid_argument);
  EXPECT_THROW(FitLogistic({}, {true}, {}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
