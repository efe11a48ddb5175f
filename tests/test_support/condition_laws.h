// Populations of conditions whose mean rate and intraclass correlation are known, for what measures
// intervals.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "stats/population_rate.h"
#include "stats/random.h"

namespace rcme {

// The law of a condition's rate, with mean p and variance rho p (1 - p), so that rho is the intraclass
// correlation of its trials; rho = 0: all have the rate p.
class RateLaw {
 public:
  enum class Shape {
    kBeta,
    kNeverOrHigh,  // 0, or p + rho (1 - p)
    kLowOrAlways,  // p (1 - rho), or 1
    kLogitNormal
  };

  RateLaw(Shape shape, double p, double rho) : shape_(shape), p_(p), rho_(rho) {
    if (shape == Shape::kLogitNormal && rho > 0.0) FitLogitNormal();
  }

  double p() const { return p_; }
  double rho() const { return rho_; }

  double Draw(RandomStream& rng) const {
    if (rho_ == 0.0) return p_;
    const double high = p_ + rho_ * (1.0 - p_), low = p_ * (1.0 - rho_);
    switch (shape_) {
      case Shape::kBeta:
        return DrawBeta(p_ * (1.0 / rho_ - 1.0), (1.0 - p_) * (1.0 / rho_ - 1.0), rng);
      case Shape::kNeverOrHigh:
        return rng.Uniform() < p_ / high ? high : 0.0;
      case Shape::kLowOrAlways:
        return rng.Uniform() < (p_ - low) / (1.0 - low) ? 1.0 : low;
      case Shape::kLogitNormal:
        break;
    }
    return Logistic(mean_ + sd_ * rng.Normal());
  }

 private:
  static double Logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

  // Marsaglia & Tsang (2000); of a shape below 1 that of one more times U^(1 / shape), as a logarithm, since
  // it may be below the least double.
  static double DrawLogGamma(double shape, RandomStream& rng) {
    const double d = (shape < 1.0 ? shape + 1.0 : shape) - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
    for (;;) {
      const double x = rng.Normal(), v = std::pow(1.0 + c * x, 3.0);
      if (v <= 0.0) continue;
      if (std::log(1.0 - rng.Uniform()) >= 0.5 * x * x + d - d * v + d * std::log(v)) continue;
      const double boost = shape < 1.0 ? std::log(1.0 - rng.Uniform()) / shape : 0.0;
      return std::log(d * v) + boost;
    }
  }

  static double DrawBeta(double a, double b, RandomStream& rng) {
    const double log_a = DrawLogGamma(a, rng), log_b = DrawLogGamma(b, rng);
    return Logistic(log_a - log_b);
  }

  // Mean of the rate, or of its square, over 2001 points of the normal law.
  double MeanOfPower(double mean, double sd, int power) const {
    double sum = 0.0, weights = 0.0;
    for (int i = -1000; i <= 1000; ++i) {
      const double z = 0.008 * i, weight = std::exp(-0.5 * z * z), rate = Logistic(mean + sd * z);
      sum += weight * (power == 1 ? rate : rate * rate);
      weights += weight;
    }
    return sum / weights;
  }

  void FitLogitNormal() {
    double least = 0.01, most = 60.0;
    for (int i = 0; i < 45; ++i) {
      sd_ = std::sqrt(least * most);
      double low = -60.0 - 6.0 * sd_, high = -low;
      for (int j = 0; j < 60; ++j) {
        mean_ = 0.5 * (low + high);
        (MeanOfPower(mean_, sd_, 1) < p_ ? low : high) = mean_;
      }
      const double variance = MeanOfPower(mean_, sd_, 2) - p_ * p_;
      (variance < rho_ * p_ * (1.0 - p_) ? least : most) = sd_;
    }
  }

  Shape shape_;
  double p_, rho_;
  double mean_ = 0.0, sd_ = 0.0;
};

inline std::int64_t DrawEvents(std::int64_t num_trials, double rate, RandomStream& rng) {
  std::int64_t num_events = 0;
  for (std::int64_t i = 0; i < num_trials; ++i) num_events += rng.Uniform() < rate;
  return num_events;
}

// As many conditions as `num_trials` has entries.
inline std::vector<ConditionCount> DrawConditions(const RateLaw& law, const std::vector<int>& num_trials,
                                                  RandomStream& rng) {
  std::vector<ConditionCount> conditions;
  for (const int n : num_trials) conditions.push_back({DrawEvents(n, law.Draw(rng), rng), n});
  return conditions;
}

}  // namespace rcme
