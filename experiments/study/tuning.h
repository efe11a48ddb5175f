// What a study asks of `rcme tune`: which options of which estimator, over which levels, to meet which
// target, on how many trials.
#pragma once

#include <string>
#include <vector>

#include "experiments/study/estimator_spec.h"
#include "parameters/parameter.h"

namespace rcme {

enum class TuneTarget {
  kFalseRefusal,     // of the trials whose motion would be good without the limits (SettingPlan), at most so
                     // many are refused; then the least failure
  kFailure,          // at most so many trials fail; then the least refusal
  kAcceptedFailure,  // at most so many of the trials that are not refused fail; then the least refusal
  kRisk,             // cost_of_failure * failure + cost_of_refusal * refusal is least
};

// Whether the target limits failures, of all trials or of those that are not refused, and with them refusals.
bool LimitsFailures(TuneTarget target);

// An option of the estimator and the values it may take, as text, in the order they are given.
struct TunedOption {
  std::string name;
  std::vector<std::string> levels;
};

inline constexpr size_t kMaxTunedSettings = 20'000;  // combinations of levels

struct Tuning {
  std::string estimator;  // label in the study
  std::vector<TunedOption> options;
  TuneTarget target = TuneTarget::kFailure;
  double at_most = 0.05;     // of false refusals, or of failures
  double max_refusal = 0.5;  // target failure: a setting that refuses more is no answer
  double cost_of_failure = 1.0, cost_of_refusal = 1.0;
  double delta = 0.05;  // P(the tuned setting violates its target) is at most this
  // Trials per condition: to look for settings, to certify one, to measure it on trials that played no part.
  int explore = 100, calibrate = 400, verify = 400;
};

// The fields that are single values, by name.
std::vector<Parameter> Parameters(Tuning& tuning);

// A setting is a combination of levels. How many there are, and the levels of one, one per option, the first
// option slowest.
size_t NumSettings(const Tuning& tuning);
std::vector<std::string> LevelsOfSetting(const Tuning& tuning, size_t setting);

// The estimator with the tuned options at these levels.
EstimatorSpec WithLevels(const Tuning& tuning, const std::vector<std::string>& levels, EstimatorSpec spec);

}  // namespace rcme
