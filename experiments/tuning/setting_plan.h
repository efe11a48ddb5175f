// The settings of a tuning, grouped to save estimations: settings that differ only in decision options
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

// Settings that share a trace. If the estimator cannot be inspected (`tracer` is null), settings that share
// the estimator without its limits.
struct TraceGroup {
  std::shared_ptr<const LoopInspection> tracer;
  std::vector<size_t> settings;
};

// The option of this name refuses motions with a greater stated probability of failure and has no other
// effect. So settings that differ only in it share one call.
inline constexpr const char* kProbabilityLimit = "max_failure_probability";

struct SettingPlan {
  std::vector<TunedSetting> settings;                              // the first option varies slowest
  std::vector<std::shared_ptr<const MotionEstimator>> estimators;  // one per setting
  // The same with their limits lifted (EstimatorModel). Settings that differ only in limits share one.
  std::vector<std::shared_ptr<const MotionEstimator>> without_limits;
  // kProbabilityLimit of each setting that has no other limit; nullopt for other settings.
  std::vector<std::optional<double>> greatest_probability;
  std::vector<TraceGroup> groups;
};

// The tuning must have been read for this study (tuning_file.h).
SettingPlan MakeSettingPlan(const Study& study, const Tuning& tuning);

}  // namespace rcme
