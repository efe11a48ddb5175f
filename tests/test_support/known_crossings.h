// Curves whose crossing is known (stats/level_crossing.h), and how often an interval holds it.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "stats/level_crossing.h"
#include "stats/random.h"

namespace rcme {

struct KnownCrossing {
  std::string name;
  std::function<double(double)> rate;  // at a level in [0, 1]
  double crossing = 0.0;               // infinite: the rate never reaches the value
};

inline std::vector<KnownCrossing> KnownCrossings(double rate) {
  const auto logistic = [rate](double steepness, double at) {
    return [=](double x) { return 1.0 / (1.0 + (1.0 - rate) / rate * std::exp(-steepness * (x - at))); };
  };
  return {
      {"logistic", logistic(8.0, 0.6), 0.6},
      {"flat logistic", logistic(2.0, 0.3), 0.3},
      {"step", [rate](double x) { return x < 0.45 ? 0.2 * rate : std::min(4.0 * rate, 0.9); }, 0.45},
      {"cubic", [rate](double x) { return std::min(rate * std::pow(x / 0.7, 3.0), 1.0); }, 0.7},
      // Exactly at the value over a third of the range: the crossing is its end.
      {"plateau",
       [rate](double x) { return x < 0.3   ? 0.5 * rate
                                 : x < 0.6 ? rate
                                           : std::min(2.0 * rate, 0.9); }, 0.6},
      {"never", [rate](double x) { return rate * (0.2 + 0.6 * x); }, INFINITY},
  };
}

struct CrossingCoverage {
  int num_covered = 0, num_covered_logistic = 0;
  double median_width = 0.0, median_width_logistic = 0.0;  // of the intervals within [0, 1]
  double median_error = 0.0;                               // of the estimate, absolute, within [0, 1]
};

inline CrossingCoverage MeasureCrossingCoverage(const KnownCrossing& curve, double rate,
                                                std::int64_t num_trials, int num_searches, std::uint32_t row,
                                                double confidence = 0.95) {
  CrossingCoverage coverage;
  std::vector<double> widths, widths_logistic, errors;
  const auto width = [](const Interval& interval) {
    return std::min(interval.upper, 1.0) - std::max(interval.lower, 0.0);
  };
  for (int i = 0; i < num_searches; ++i) {
    RandomStream rng({1, row, static_cast<std::uint32_t>(i), 0});
    const auto ask = [&](double level, std::int64_t number) {
      std::int64_t num_events = 0;
      for (std::int64_t k = 0; k < number; ++k) num_events += rng.Uniform() < curve.rate(level);
      return EventsAtLevel{level, num_events, number};
    };
    const Crossing found = FindCrossing(ask, rate, num_trials, confidence);
    coverage.num_covered += found.interval.Contains(curve.crossing);
    coverage.num_covered_logistic += found.logistic_interval.Contains(curve.crossing);
    widths.push_back(width(found.interval));
    widths_logistic.push_back(width(found.logistic_interval));
    errors.push_back(std::abs(found.estimate - std::min(curve.crossing, 1.0)));
  }
  const auto median = [](std::vector<double>* values) {
    std::ranges::nth_element(*values, values->begin() + std::ssize(*values) / 2);
    return (*values)[values->size() / 2];
  };
  coverage.median_width = median(&widths);
  coverage.median_width_logistic = median(&widths_logistic);
  coverage.median_error = median(&errors);
  return coverage;
}

}  // namespace rcme
