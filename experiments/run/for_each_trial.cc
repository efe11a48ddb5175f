#include "experiments/run/for_each_trial.h"

#include "experiments/core/work/for_each_index.h"

namespace rcme {

void ForEachTrial(const StudyPlan& plan, TrialRange trials, const TrialWork& work, int num_threads) {
  const std::int64_t per_condition = trials.end - trials.first, num_conditions = std::ssize(plan.conditions);
  const bool is_by_condition = NumThreads(num_threads) == 1;
  ForEachIndex(per_condition * num_conditions, num_threads, [&](std::int64_t i) {
    const std::int64_t condition = is_by_condition ? i / per_condition : i % num_conditions;
    const std::int64_t place = is_by_condition ? i % per_condition : i / num_conditions;
    work(plan.conditions[static_cast<size_t>(condition)], trials.first + static_cast<std::uint32_t>(place),
         condition * per_condition + place);
  });
}

}  // namespace rcme
