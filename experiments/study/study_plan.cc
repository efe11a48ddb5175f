#include "experiments/study/study_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "experiments/data/calibration_file.h"
#include "experiments/data/camera_noise.h"
#include "experiments/data/make_data.h"
#include "experiments/study/command_files.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"
#include "parameters/settings.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

// Formats the settings of a condition; those of a draw, which are many, as a hash.
std::string TextOfSettings(const Settings& settings, bool is_drawn) {
  std::string text;
  for (const auto& [key, value] : settings) text += fmt::format(" {} {},", key, value);
  if (!is_drawn) return text;
  Fnv1a hash;
  hash.Add(text);
  return fmt::format(" settings {:016x}", hash.value());
}

// If a factor chooses a part of the simulation, ToYaml cannot write the parameters of every choice, so the
// identity lists them by condition.
std::string ResolvedConditions(const StudyPlan& plan) {
  const bool has_choice =
      plan.study.population || std::ranges::any_of(plan.study.factors, IsChoice, &Factor::key);
  std::string text;
  for (const Condition& condition : plan.conditions) {
    if (!has_choice) continue;
    const Settings settings = ResolveSettings(CombineSettings(plan.study, condition.levels));
    text += fmt::format("# condition {}:{}\n", condition.index,
                        TextOfSettings(settings, plan.study.population.has_value()));
  }
  return text;
}

std::string Identity(const StudyPlan& plan) {
  Study same = plan.study;
  same.trials = 1;  // more trials extend a run
  same.description.clear();
  same.ademp.reset();
  same.hypotheses.clear();
  // The content of the files counts, not these settings.
  std::erase_if(same.data, [](const auto& setting) {
    return setting.first == "folder" || setting.first == kTruthInDoubtKey;
  });
  std::string identity = ToYaml(same) + ResolvedConditions(plan);
  if (same.population) identity += DescribePopulationIdentity(*same.population, plan.refused);
  for (const Condition& condition : plan.conditions) {
    // The settings of a draw determine its data.
    if (same.population && !condition.source->ChosenParts().empty()) continue;
    const std::string data = condition.source->Identity();
    if (!data.empty()) identity += fmt::format("# condition {}: {}\n", condition.index, data);
  }
  return identity + IdentifyCommandFiles(plan.study.estimators);
}

// Returns a text that is equal for two conditions that draw the same scenes, noise and outliers. These have
// equivalent settings, in any study; with common_scenes, equivalent settings of the scene. `pair_scene`: the
// scene of a folder.
std::string WhatIsDrawn(const Study& study, const Settings& settings, const std::string& pair_scene) {
  std::string text;
  for (const auto& [key, value] : DistinctiveSettings(settings, study.common_scenes)) {
    text += key + "=" + value + "\n";
  }
  return text + pair_scene;
}

// The conditions of one row of the design, without their indices.
struct RowConditions {
  std::string implied_factor;
  std::vector<Condition> conditions;
};

RowConditions MakeRowConditions(const Study& study, const std::vector<std::string>& levels) {
  const Settings settings = CombineSettings(study, levels);
  DataSources made =
      MakeDataSources(settings, study.population ? BaselineTiming::kWithFirstScene : BaselineTiming::kNow);
  RowConditions row{std::move(made.implied_factor), {}};
  for (const auto& [level, source] : made.sources) {
    Condition condition{0, levels, source, source->NumTrials(study.trials),
                        HashToStreamKey(WhatIsDrawn(study, settings, level))};
    if (!row.implied_factor.empty()) condition.levels.push_back(level);
    row.conditions.push_back(std::move(condition));
  }
  return row;
}

void Append(RowConditions row, StudyPlan* plan) {
  if (plan->conditions.empty() && !row.implied_factor.empty())
    plan->factor_names.push_back(row.implied_factor);
  for (Condition& condition : row.conditions) {
    condition.index = static_cast<std::uint32_t>(plan->conditions.size());
    plan->conditions.push_back(std::move(condition));
  }
}

void AppendPopulation(StudyPlan* plan) {
  const std::vector<PopulationDraw> draws = DrawPopulation(plan->study);
  const std::vector<std::vector<std::string>> of_factors = FactorRows(plan->study);
  if (draws.size() * of_factors.size() > kMaxConditions)
    throw InputError(
        fmt::format("conditions: more than {} draws and combinations of levels", kMaxConditions));
  for (const PopulationDraw& draw : draws) {
    if (!draw.outside_of.empty()) {
      plan->refused.push_back({draw.number, draw.outside_of});
      continue;
    }
    for (const std::vector<std::string>& levels : of_factors)
      Append(MakeRowConditions(plan->study, JoinLevels(draw, levels)), plan);
  }
  if (plan->conditions.empty()) {
    throw InputError(fmt::format("conditions: none of {} draws meets what is given; the first: {}",
                                 draws.size(), plan->refused.front().outside_of));
  }
}

// Makes estimators with varied options, once for all conditions that have the same options.
void MakeEstimatorsOfConditions(StudyPlan* plan) {
  if (std::ranges::none_of(plan->study.factors, IsEstimatorOption, &Factor::key)) return;
  std::map<Settings, std::vector<std::shared_ptr<const MotionEstimator>>> made;
  for (Condition& condition : plan->conditions) {
    Settings options;
    for (size_t f = 0; f < plan->factor_names.size(); ++f) {
      if (IsEstimatorOption(plan->factor_names[f]))
        options.emplace_back(plan->factor_names[f], condition.levels[f]);
    }
    const auto [found, is_new] = made.try_emplace(options);
    if (is_new) {
      for (const EstimatorSpec& spec : ResolveEstimators(plan->study, condition.levels))
        found->second.push_back(Make(spec));
    }
    condition.estimators = found->second;
  }
}

}  // namespace

std::int64_t StudyPlan::NumTrials() const {
  std::int64_t sum = 0;
  for (const Condition& condition : conditions) sum += condition.num_trials;
  return sum;
}

const std::vector<std::shared_ptr<const MotionEstimator>>& FindEstimators(const StudyPlan& plan,
                                                                          const Condition& condition) {
  return condition.estimators.empty() ? plan.estimators : condition.estimators;
}

StreamName NameOfTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial) {
  return {plan.study.seed, condition.stream_key, trial, 0};
}

StreamName NameOfScene(const StudyPlan& plan, const Condition& condition, std::uint32_t trial) {
  return NameOfTrial(plan, condition, trial / static_cast<std::uint32_t>(plan.study.repeats_per_scene));
}

namespace {

// Makes a plan without conditions and estimators.
StudyPlan BeginPlan(const Study& given, PlanEstimators estimators) {
  if (estimators == PlanEstimators::kMade) RequireAllowedCommands(given.estimators);
  Study study = given;
  study.data = WithNoiseFile(WithCalibration(given.data));
  if (std::ranges::count(study.factors, kCalibrationKey, &Factor::key) > 0) {
    throw InputError(fmt::format("factors: {} cannot vary; give the intrinsics of own_intrinsics as factors",
                                 kCalibrationKey));
  }
  if (std::ranges::count(study.factors, kNoiseFileKey, &Factor::key) > 0)
    throw InputError(
        fmt::format("factors: {} cannot vary; give sigma_px, displacement_share and "
                    "displacement_reach_px of displacement_field as factors",
                    kNoiseFileKey));
  if (study.common_scenes && FindSetting(study.data, "scene") == kMatchFilesScene) {
    throw InputError("common_scenes: pairs of match files have no scenes to share; leave it out");
  }
  if (study.common_scenes && study.population)
    throw InputError(
        "common_scenes: every draw of a population (conditions) has scenes of its own, or its rates would say "
        "nothing of other draws; leave it out");
  StudyPlan plan;
  plan.study = study;
  plan.factor_names = FactorNames(study);
  return plan;
}

void MakeEstimators(StudyPlan* plan) {
  for (const EstimatorSpec& spec : plan->study.estimators) plan->estimators.push_back(Make(spec));
  MakeEstimatorsOfConditions(plan);
}

}  // namespace

StudyPlan MakePlan(const Study& given, PlanEstimators estimators) {
  StudyPlan plan = BeginPlan(given, estimators);
  if (plan.study.population) {
    AppendPopulation(&plan);
  } else {
    for (const std::vector<std::string>& levels : DesignRows(plan.study))
      Append(MakeRowConditions(plan.study, levels), &plan);
  }
  if (estimators == PlanEstimators::kMade) MakeEstimators(&plan);
  plan.study_yaml = ToYaml(plan.study);
  plan.identity = Identity(plan);
  return plan;
}

StudyPlan MakeConditionPlan(const Study& study, const std::vector<std::string>& levels) {
  StudyPlan plan = BeginPlan(study, PlanEstimators::kMade);
  Append(MakeRowConditions(plan.study, levels), &plan);
  MakeEstimators(&plan);
  return plan;
}

StudyPlan MakePlan(const Study& study, const std::string& path, PlanEstimators estimators) {
  try {
    return MakePlan(study, estimators);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace rcme
