#include "experiments/run/for_each_trial.h"

#include <algorithm>
#include <iterator>

#include "experiments/core/work/for_each_index.h"

namespace rcme {

std::vector<TrialsOfCondition> TrialsOfEach(const StudyPlan& plan, TrialRange trials) {
  std::vector<TrialsOfCondition> all;
  for (const Condition& condition : plan.conditions) all.push_back({&condition, trials});
  return all;
}

std::int64_t NumTrials(const std::vector<TrialsOfCondition>& trials) {
  std::int64_t sum = 0;
  for (const TrialsOfCondition& part : trials) sum += part.trials.end - part.trials.first;
  return sum;
}

void ForEachTrial(const std::vector<TrialsOfCondition>& trials, int num_threads, Progress* progress,
                  const TrialWork& work) {
  std::vector<std::int64_t> first_index;  // of each part
  std::int64_t num_trials = 0;
  for (const TrialsOfCondition& part : trials) {
    first_index.push_back(num_trials);
    num_trials += part.trials.end - part.trials.first;
  }
  ForEachIndex(num_trials, num_threads, [&](std::int64_t index) {
    // The last part that begins at the index or before: one that is empty begins where the next does.
    const auto p =
        static_cast<size_t>(std::ranges::upper_bound(first_index, index) - first_index.begin()) - 1;
    const auto offset = static_cast<std::uint32_t>(index - first_index[p]);
    const TrialsOfCondition& part = trials[p];
    work(*part.condition, part.shard.TrialAt(part.trials.first + offset), index);
    if (progress) progress->Advance(1);
  });
}

}  // namespace rcme
