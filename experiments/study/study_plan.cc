#include "experiments/study/study_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/data/calibration_file.h"
#include "experiments/data/make_data.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"

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

}  // namespace

std::int64_t StudyPlan::NumTrials() const {
  std::int64_t sum = 0;
  for (const Condition& condition : conditions) sum += condition.num_trials;
  return sum;
}

StudyPlan MakePlan(const Study& given) {
  Study study = given;
  study.data = WithCalibration(given.data);
  if (std::ranges::count(study.factors, kCalibrationKey, &Factor::key) > 0) {
    throw InputError(fmt::format("factors: {} cannot vary; give the intrinsics of own_intrinsics as factors",
                                 kCalibrationKey));
  }
  StudyPlan plan;
  plan.study = study;
  for (const Factor& factor : study.factors) plan.factor_names.push_back(factor.key);
  for (const std::vector<std::string>& levels : DesignRows(study)) {
    const DataSources made = MakeDataSources(SettingsOf(study, levels));
    const bool is_first = plan.conditions.empty();
    if (is_first && !made.implied_factor.empty()) plan.factor_names.push_back(made.implied_factor);
    for (const auto& [level, source] : made.sources) {
      Condition condition{static_cast<std::uint32_t>(plan.conditions.size()), levels, source,
                          source->NumTrials(study.trials)};
      if (!made.implied_factor.empty()) condition.levels.push_back(level);
      plan.conditions.push_back(std::move(condition));
    }
  }
  for (const EstimatorSpec& spec : study.estimators) {
    plan.estimators.push_back(Make(spec));
  }
  plan.study_yaml = ToYaml(study);
  plan.identity = Identity(plan);
  return plan;
}

StudyPlan PlanOf(const Study& study, const std::string& path) {
  try {
    return MakePlan(study);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace rcme
