#include "experiments/study/study_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/data/calibration_file.h"
#include "experiments/data/make_data.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

// Where a factor chooses a part of the simulation, ToYaml cannot write out the parameters of every choice.
std::string ResolvedConditions(const StudyPlan& plan) {
  const bool has_choice = std::ranges::any_of(plan.study.factors, IsChoice, &Factor::key);
  std::string text;
  for (const Condition& condition : plan.conditions) {
    if (!has_choice) continue;
    text += fmt::format("# condition {}:", condition.index);
    for (const auto& [key, value] : ResolveSettings(SettingsOf(plan.study, condition.levels))) {
      text += fmt::format(" {} {},", key, value);
    }
    text += "\n";
  }
  return text;
}

std::string Identity(const StudyPlan& plan) {
  Study same = plan.study;
  same.trials = 1;  // more trials extend a run
  same.description.clear();
  same.ademp.reset();
  std::erase_if(same.data, [](const auto& setting) { return setting.first == "folder"; });  // its data count
  std::string identity = ToYaml(same) + ResolvedConditions(plan);
  for (const Condition& condition : plan.conditions) {
    const std::string data = condition.source->Identity();
    if (!data.empty()) identity += fmt::format("# condition {}: {}\n", condition.index, data);
  }
  return identity;
}

// Equal for two conditions that draw the same scenes, noise and outliers: those that mean the same, in any
// study; with common_scenes those whose scene is shaped alike. `pair_scene`: which scene of a folder.
std::string WhatIsDrawn(const Study& study, const Settings& settings, const std::string& pair_scene) {
  std::string text;
  for (const auto& [key, value] : DistinctiveSettings(settings, study.common_scenes)) {
    text += key + "=" + value + "\n";
  }
  return text + pair_scene;
}

}  // namespace

std::int64_t StudyPlan::NumTrials() const {
  std::int64_t sum = 0;
  for (const Condition& condition : conditions) sum += condition.num_trials;
  return sum;
}

StreamName NameOfTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial) {
  return {plan.study.seed, condition.stream_key, trial, 0};
}

StreamName NameOfScene(const StudyPlan& plan, const Condition& condition, std::uint32_t trial) {
  return NameOfTrial(plan, condition, trial / static_cast<std::uint32_t>(plan.study.repeats_per_scene));
}

StudyPlan MakePlan(const Study& given, PlanEstimators estimators) {
  if (estimators == PlanEstimators::kMade) RequireAllowedCommands(given.estimators);
  Study study = given;
  study.data = WithCalibration(given.data);
  if (std::ranges::count(study.factors, kCalibrationKey, &Factor::key) > 0) {
    throw InputError(fmt::format("factors: {} cannot vary; give the intrinsics of own_intrinsics as factors",
                                 kCalibrationKey));
  }
  if (study.common_scenes &&
      std::ranges::count(study.data, Settings::value_type("scene", kMatchFilesScene)) > 0) {
    throw InputError("common_scenes: pairs of match files have no scenes to share; leave it out");
  }
  StudyPlan plan;
  plan.study = study;
  for (const Factor& factor : study.factors) plan.factor_names.push_back(factor.key);
  for (const std::vector<std::string>& levels : DesignRows(study)) {
    const Settings settings = SettingsOf(study, levels);
    const DataSources made = MakeDataSources(settings);
    const bool is_first = plan.conditions.empty();
    if (is_first && !made.implied_factor.empty()) plan.factor_names.push_back(made.implied_factor);
    for (const auto& [level, source] : made.sources) {
      Condition condition{static_cast<std::uint32_t>(plan.conditions.size()), levels, source,
                          source->NumTrials(study.trials),
                          HashToStreamKey(WhatIsDrawn(study, settings, level))};
      if (!made.implied_factor.empty()) condition.levels.push_back(level);
      plan.conditions.push_back(std::move(condition));
    }
  }
  if (estimators == PlanEstimators::kMade) {
    for (const EstimatorSpec& spec : study.estimators) plan.estimators.push_back(Make(spec));
  }
  plan.study_yaml = ToYaml(study);
  plan.identity = Identity(plan);
  return plan;
}

StudyPlan PlanOf(const Study& study, const std::string& path, PlanEstimators estimators) {
  try {
    return MakePlan(study, estimators);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace rcme
