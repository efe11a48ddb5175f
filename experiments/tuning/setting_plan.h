// The settings of a tuning, and how few estimations they take: settings that differ in decision options alone
// (estimator/loop_inspection.h) share one trace per trial.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimator/loop_inspection.h"
#include "experiments/study/study.h"
#include "experiments/study/tuning.h"

namespace rcme {

// One combination of levels.
struct TunedSetting {
  std::vector<std::string> levels;  // one per tuned option
  EstimatorSpec spec;               // the study's estimator with these levels
};

// Settings that share a trace; or, where the estimator cannot be inspected (null), the estimator without its
// limits.
struct TraceGroup {
  std::shared_ptr<const LoopInspection> tracer;
  std::vector<size_t> settings;
};

// An option of this name refuses the motions whose stated probability of failure is greater, and changes
// nothing else: settings that differ in it alone share one call.
inline constexpr const char* kProbabilityLimit = "max_failure_probability";

struct SettingPlan {
  std::vector<TunedSetting> settings;                              // the first option slowest
  std::vector<std::shared_ptr<const MotionEstimator>> estimators;  // of each setting
  // The same with its limits lifted (EstimatorModel). Settings that differ in limits alone share one.
  std::vector<std::shared_ptr<const MotionEstimator>> without_limits;
  // Of each setting the kProbabilityLimit that is all that its limits are; nothing: they are something else.
  std::vector<std::optional<double>> greatest_probability;
  std::vector<TraceGroup> groups;
};

// The tuning is one that was read for the study (tuning_file.h).
SettingPlan MakeSettingPlan(const Study& study, const Tuning& tuning);

}  // namespace rcme
