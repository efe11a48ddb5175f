#include "experiments/tuning/setting_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "estimator/estimator_registry.h"
#include "experiments/study/tuning_file.h"

namespace rcme {
namespace {

// What the options have in common of those that share a trace, as text.
std::string TraceKey(RansacOptions options) {
  std::string key;
  for (const Parameter& parameter : Parameters(options)) {
    if (std::ranges::find(kDecisionOptions, parameter.name()) == std::end(kDecisionOptions)) {
      key += parameter.Value() + ' ';
    }
  }
  return key;
}

// The options whose trace serves all of them: as many hypotheses as any looks at, with likelihoods if any
// selects by them, none left out by an early stop.
RansacOptions TraceOptions(const SettingPlan& plan, const std::vector<size_t>& settings) {
  RansacOptions options = plan.settings[settings.front()].spec.options;
  options.early_stop_entropy = RansacOptions().early_stop_entropy;
  for (const size_t s : settings) {
    const RansacOptions& other = plan.settings[s].spec.options;
    options.num_iterations = std::max(options.num_iterations, other.num_iterations);
    if (other.selection == Selection::kPredictiveLikelihood) options.selection = other.selection;
  }
  return options;
}

// Without what makes an estimator refuse a motion it has: mu, a given omega_p, the share to be explained.
RansacOptions WithoutLimits(RansacOptions options) {
  options.mu = kNoQualityTest;
  options.inlier_ratio = RansacOptions().inlier_ratio;  // inferred: the largest inlier set is large enough
  options.least_explained_share = 0.0;
  return options;
}

void AddEstimators(const EstimatorEntry& entry, SettingPlan* plan) {
  std::map<std::string, std::shared_ptr<const MotionEstimator>> shared;
  for (const TunedSetting& setting : plan->settings) {
    plan->estimators.push_back(entry.make(setting.spec.options));
    RansacOptions options = WithoutLimits(setting.spec.options);
    std::string key;
    for (const Parameter& parameter : Parameters(options)) key += parameter.Value() + ' ';
    std::shared_ptr<const MotionEstimator>& estimator = shared[key];
    if (!estimator) estimator = entry.make(options);
    plan->without_limits.push_back(estimator);
  }
}

void AddGroups(const EstimatorEntry& entry, SettingPlan* plan) {
  std::map<std::string, std::vector<size_t>> groups;
  for (size_t s = 0; s < plan->settings.size(); ++s) {
    const bool shares = AsRansac(*plan->estimators[s]) != nullptr;
    groups[shares ? TraceKey(plan->settings[s].spec.options) : fmt::format("{}", s)].push_back(s);
  }
  for (const auto& [key, settings] : groups) {
    plan->groups.push_back({entry.make(TraceOptions(*plan, settings)), settings});
  }
}

}  // namespace

SettingPlan MakeSettingPlan(const Study& study, const Tuning& tuning) {
  const EstimatorSpec& base = TunedEstimator(tuning, study.estimators);
  SettingPlan plan;
  for (size_t s = 0; s < NumSettings(tuning); ++s) {
    TunedSetting setting{LevelsOfSetting(tuning, s), base};
    setting.spec.options = WithLevels(tuning, setting.levels, base.options);
    plan.settings.push_back(std::move(setting));
  }
  const EstimatorEntry& entry = FindEstimator(base.name);
  AddEstimators(entry, &plan);
  AddGroups(entry, &plan);
  return plan;
}

}  // namespace rcme
