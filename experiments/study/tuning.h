// The task of `rcme tune`: which options of which estimator to choose from which levels, for which target,
// with how many trials.
#pragma once

#include <string>
#include <vector>

#include "experiments/study/estimator_spec.h"
#include "parameters/parameter.h"

namespace rcme {

enum class TuneTarget {
  kFalseRefusal,     // at most this share of the trials that the setting without limits (SettingPlan) would
                     // answer well is refused; the failure rate is minimized
  kFailure,          // at most this share of trials fails; the refusal rate is minimized
  kAcceptedFailure,  // at most this share of answered trials fails; the refusal rate is minimized
  kRisk,             // cost_of_failure * failure + cost_of_refusal * refusal is minimized
};

// Returns whether the target bounds the failure rate, among all trials or among those not refused. Such a
// target also bounds the refusal rate (max_refusal).
bool LimitsFailures(TuneTarget target);

// An option of the estimator and its possible values as text, in the given order.
struct TunedOption {
  std::string name;
  std::vector<std::string> levels;
};

inline constexpr size_t kMaxTunedSettings = 20'000;  // combinations of levels

struct Tuning {
  std::string estimator;  // label in the study
  std::vector<TunedOption> options;
  TuneTarget target = TuneTarget::kFailure;
  double at_most = 0.05;     // bound of false refusals or of failures
  double max_refusal = 0.5;  // targets failure and accepted_failure: settings that refuse more are rejected
  double cost_of_failure = 1.0, cost_of_refusal = 1.0;
  double delta = 0.05;  // the tuned setting violates its target with at most this probability
  // Trials per condition: to propose settings, to certify one, and to measure it on fresh trials.
  int explore = 100, calibrate = 400, verify = 400;
};

// Returns the fields with a single value, by name.
std::vector<Parameter> Parameters(Tuning& tuning);

// A setting is a combination of levels. NumSettings counts them; LevelsOfSetting returns the levels of one,
// one per option, the first option slowest.
size_t NumSettings(const Tuning& tuning);
std::vector<std::string> LevelsOfSetting(const Tuning& tuning, size_t setting);

// Returns the estimator with the tuned options at these levels.
EstimatorSpec WithLevels(const Tuning& tuning, const std::vector<std::string>& levels, EstimatorSpec spec);

}  // namespace rcme
