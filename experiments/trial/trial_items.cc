#include "experiments/trial/trial_items.h"

#include <fmt/format.h>

#include <algorithm>

#include "parameters/input_error.h"

namespace rcme {

WorkPlan PlanTrialItems(const StudyPlan& plan, const std::string& work, std::uint32_t trials_of_item,
                        const std::string& identity) {
  // Blocks of as many groups and items may hold other numbers of trials.
  const std::string trials = fmt::format("trials of a condition: {}\n", plan.study.trials);
  WorkPlan items{work, "block", identity + trials + plan.identity, {}};
  for (const Condition& condition : plan.conditions) {
    const auto num_trials = static_cast<size_t>(condition.num_trials);
    items.groups.push_back(
        {fmt::format("condition {}", condition.index), (num_trials + trials_of_item - 1) / trials_of_item});
  }
  return items;
}

TrialRange FindTrialsOfItem(const StudyPlan& plan, const ItemPlace& place, std::uint32_t trials_of_item) {
  const auto first = static_cast<std::uint32_t>(place.item) * trials_of_item;
  const auto end = static_cast<std::uint32_t>(plan.conditions[place.group].num_trials);
  return {first, std::min(first + trials_of_item, end)};
}

void GetTrialItems(const StudyPlan& plan, std::uint32_t trials_of_item, const ComputeTrials& compute,
                   Runner* runner) {
  const ProgressUnit unit{"trials", [&](const ItemPlace& place) -> std::int64_t {
                            const TrialRange trials = FindTrialsOfItem(plan, place, trials_of_item);
                            return trials.end - trials.first;
                          }};
  runner->Get(
      ListItems(runner->plan(), runner->shard()),
      [&](const ItemPlace& place) {
        return compute(plan.conditions[place.group], FindTrialsOfItem(plan, place, trials_of_item));
      },
      unit);
}

void RequireUnweighted(const StudyPlan& plan, const std::string& command) {
  for (const Condition& condition : plan.conditions) {
    if (condition.source->ChosenParts().empty()) continue;
    for (const auto& [key, value] : CombineSettings(plan.study, condition.levels))
      if (key == "tilted_to" && value != "none")
        throw InputError(command + ": the trials of this study are weighted (tilted_to); leave that out");
  }
}

}  // namespace rcme
