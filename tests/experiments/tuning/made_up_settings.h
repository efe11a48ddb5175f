// Tunings, counts and names for tests of the choice among settings.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/tuning/choose_setting.h"

namespace rcme {

inline Tuning TuningFor(TuneTarget target, double at_most, double max_refusal = 1.0) {
  Tuning tuning;
  tuning.target = target;
  tuning.at_most = at_most;
  tuning.max_refusal = max_refusal;
  return tuning;
}

// Failures and refusals of n trials.
inline SettingCount Of(std::int64_t n, std::int64_t failures, std::int64_t refusals) {
  return {n, failures, refusals, n - failures - refusals, 0};
}

inline std::vector<std::string> Names(size_t n) {
  std::vector<std::string> names;
  for (size_t s = 0; s < n; ++s) names.push_back("mu = " + std::to_string(s));
  return names;
}

inline Choice Choose(const Tuning& tuning, const std::vector<SettingCount>& explored,
                     const std::vector<SettingCount>& calibrated) {
  return ChooseSetting(tuning, Names(explored.size()), explored, calibrated);
}

}  // namespace rcme
