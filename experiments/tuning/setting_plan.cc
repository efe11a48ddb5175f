#include "experiments/tuning/setting_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "experiments/study/command_permission.h"
#include "experiments/study/tuning_file.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// The options that settings with one trace have in common, as text.
std::string TraceKey(const Settings& options) {
  std::string key;
  for (const auto& [option, value] : options) {
    if (std::ranges::find(kDecisionOptions, option) == std::end(kDecisionOptions)) key += value + ' ';
  }
  return key;
}

std::string MakeSettingKey(const Settings& options) {
  std::string key;
  for (const auto& [option, value] : options) key += value + ' ';
  return key;
}

// An inspection whose trace serves all of the settings. It has the most hypotheses that any of them needs,
// with likelihoods if any selects by them, and no early stop.
std::shared_ptr<const LoopInspection> MakeTracer(const SettingPlan& plan,
                                                 const std::vector<size_t>& settings) {
  const LoopInspection& first = *FindInspection(*plan.estimators[settings.front()]);
  RansacOptions options = first.options();
  options.early_stop_entropy = RansacOptions().early_stop_entropy;
  for (const size_t s : settings) {
    const RansacOptions& other = FindInspection(*plan.estimators[s])->options();
    options.num_iterations = std::max(options.num_iterations, other.num_iterations);
    if (other.selection == Selection::kPredictiveLikelihood) options.selection = other.selection;
  }
  return first.With(options);
}

// The value of kProbabilityLimit if the options differ only in it from those without limits.
std::optional<double> FindProbabilityLimit(const Settings& options, const Settings& without_limits) {
  std::optional<double> limit;
  for (size_t i = 0; i < options.size(); ++i) {
    const auto& [name, value] = options[i];
    double number = 0.0;
    if (name == kProbabilityLimit && ParseReal(value, &number)) {
      limit = number;
    } else if (options[i] != without_limits[i]) {
      return std::nullopt;
    }
  }
  return limit;
}

// Returns whether any setting has a limit to lift.
bool AddEstimators(SettingPlan* plan) {
  bool has_limits = false;
  std::map<std::string, std::shared_ptr<const MotionEstimator>> shared;
  for (const TunedSetting& setting : plan->settings) {
    const std::unique_ptr<EstimatorModel> model = Configure(setting.spec);
    plan->estimators.push_back(model->Make());
    model->LiftLimits();
    const Settings without_limits = ListValues(model->Parameters());
    has_limits = has_limits || without_limits != setting.spec.options;
    plan->greatest_probability.push_back(FindProbabilityLimit(setting.spec.options, without_limits));
    std::shared_ptr<const MotionEstimator>& estimator = shared[MakeSettingKey(without_limits)];
    if (!estimator) estimator = model->Make();
    plan->without_limits.push_back(estimator);
  }
  return has_limits;
}

void AddGroups(SettingPlan* plan) {
  std::map<std::string, std::vector<size_t>> groups;
  // the group of each estimator without limits that is not inspected
  std::map<const MotionEstimator*, size_t> in_one_piece;
  for (size_t s = 0; s < plan->settings.size(); ++s) {
    if (FindInspection(*plan->estimators[s])) {
      groups[TraceKey(plan->settings[s].spec.options)].push_back(s);
    } else {
      const auto [group, is_new] =
          in_one_piece.try_emplace(plan->without_limits[s].get(), plan->groups.size());
      if (is_new) plan->groups.push_back({nullptr, {}});
      plan->groups[group->second].settings.push_back(s);
    }
  }
  for (const auto& [key, settings] : groups) plan->groups.push_back({MakeTracer(*plan, settings), settings});
}

}  // namespace

SettingPlan MakeSettingPlan(const Study& study, const Tuning& tuning) {
  RequireFixedOptions(study, "tuning");
  const EstimatorSpec& base = TunedEstimator(tuning, study.estimators);
  RequireAllowedCommands({base});
  SettingPlan plan;
  for (size_t s = 0; s < NumSettings(tuning); ++s) {
    const std::vector<std::string> levels = LevelsOfSetting(tuning, s);
    plan.settings.push_back({levels, WithLevels(tuning, levels, base)});
  }
  const bool has_limits = AddEstimators(&plan);
  if (tuning.target == TuneTarget::kFalseRefusal && !has_limits) {
    throw InputError(fmt::format(
        "tune: target: false_refusal: no setting of {} has a limit to lift, so nothing is refused falsely; "
        "tune for failure or risk",
        base.label));
  }
  AddGroups(&plan);
  return plan;
}

}  // namespace rcme
