#pragma once

#include <cstdint>
#include <vector>

#include "stats/forecast.h"

namespace rcme {

// FORECASTS of tests/known_answers/forecasts.py: ties, clusters, a 0 and a 1.
inline std::vector<Forecast> ExampleForecasts() {
  const struct {
    int tenths;
    bool happened;
    std::int64_t cluster;
  } kRows[] = {{1, false, 0}, {1, true, 0}, {2, false, 1}, {3, false, 1}, {3, true, 1},  {3, false, 2},
               {4, false, 3}, {5, true, 3}, {6, true, 3},  {6, false, 4}, {7, false, 5}, {8, true, 5},
               {9, true, 6},  {9, true, 6}, {10, true, 7}, {0, false, 8}};
  std::vector<Forecast> forecasts;
  for (const auto& row : kRows) forecasts.push_back({row.tenths / 10.0, row.happened, row.cluster});
  return forecasts;
}

// Independent forecasts p, uniform on [0, 1], of events that happen with probability `happens(p)`.
template <typename Happens>
std::vector<Forecast> UniformForecasts(int n, Happens&& happens, RandomStream& rng) {
  std::vector<Forecast> forecasts;
  for (int i = 0; i < n; ++i) {
    const double p = rng.Uniform();
    forecasts.push_back({p, rng.Uniform() < happens(p), i});
  }
  return forecasts;
}

}  // namespace rcme
