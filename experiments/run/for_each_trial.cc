#include "experiments/run/for_each_trial.h"

#include "experiments/core/work/for_each_index.h"

namespace rcme {

void ForEachTrial(const StudyPlan& plan, TrialRange trials, const TrialWork& work, int num_threads) {
  const std::int64_t per_condition = trials.end - trials.first;
  ForEachIndex(per_condition * std::ssize(plan.conditions), num_threads, [&](std::int64_t index) {
    const auto place = static_cast<std::uint32_t>(index % per_condition);
    work(plan.conditions[static_cast<size_t>(index / per_condition)], trials.first + place, index);
  });
}

}  // namespace rcme
