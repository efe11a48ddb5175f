#include "experiments/trial/trial_grouping.h"

#include <optional>
#include <set>

#include "experiments/study/population.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

std::int64_t MakeGroup(std::int64_t high, std::uint32_t low) { return (high << 32) + low; }

std::set<std::string> RealScenes(const StudyPlan& plan) {
  std::set<std::string> scenes;
  for (const Condition& condition : plan.conditions)
    if (const std::optional<std::string> scene = condition.source->SharedScene()) scenes.insert(*scene);
  return scenes;
}

}  // namespace

TrialGrouping::TrialGrouping(const StudyPlan& plan, NewProblem new_problem)
    : plan_(plan), new_problem_(new_problem) {
  if (new_problem == NewProblem::kCondition && plan.study.common_scenes)
    throw InputError("the conditions share their scenes (common_scenes), so none is new; give --new trial");
  for (const std::string& scene : RealScenes(plan))
    scenes_.emplace(scene, static_cast<std::int64_t>(scenes_.size()));
}

std::int64_t TrialGrouping::FindGroup(const Condition& condition, std::uint32_t trial) const {
  const bool is_new_condition = new_problem_ == NewProblem::kCondition;
  if (const std::optional<std::string> scene = condition.source->SharedScene()) {
    const auto pairs = static_cast<std::uint32_t>(condition.source->NumTrials(1));
    return MakeGroup(scenes_.at(*scene), is_new_condition ? 0 : trial % pairs);
  }
  if (is_new_condition) {  // conditions of one draw differ only in the factors
    const std::optional<int> draw = FindDraw(plan_.factor_names, condition.levels);
    return MakeGroup(draw ? std::int64_t{*draw} : std::int64_t{condition.index}, 0);
  }
  const auto repeats = static_cast<std::uint32_t>(plan_.study.repeats_per_scene);
  return MakeGroup(plan_.study.common_scenes ? 0 : condition.index, trial / repeats);
}

NewProblem UsualNewProblem(const StudyPlan& plan) {
  return plan.study.population || RealScenes(plan).size() > 1 ? NewProblem::kCondition : NewProblem::kTrial;
}

bool HasRealScenes(const StudyPlan& plan) { return !RealScenes(plan).empty(); }

}  // namespace rcme
