#include "experiments/run/run_trials.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "experiments/core/text/message.h"
#include "experiments/core/work/for_each_index.h"
#include "experiments/run/outcome_watch.h"
#include "experiments/run/store/result_store.h"

namespace rcme {
namespace {

// The trials that a run still has to compute, numbered from 0 in the plan's order.
class TrialsToRun {
 public:
  TrialsToRun(const StudyPlan& plan, const Shard& shard, TrialKeeper* keeper) {
    for (const Condition& condition : plan.conditions) {
      const auto num_trials = static_cast<std::uint32_t>(condition.num_trials);
      const ShardTrials of_shard(shard, condition.index, plan.study.repeats_per_scene);
      num_trials_ += of_shard.NumBefore(num_trials);
      for (const TrialRange& range : keeper->MissingTrials(condition.index, num_trials, of_shard)) {
        missing_.push_back({num_missing_, range.first, of_shard, &condition});
        num_missing_ += range.end - range.first;
      }
    }
  }

  std::int64_t num_trials() const { return num_trials_; }  // with those kept before
  std::int64_t num_missing() const { return num_missing_; }
  std::pair<const Condition*, std::uint32_t> At(std::int64_t index) const {
    const Missing& range = *std::prev(std::ranges::upper_bound(missing_, index, {}, &Missing::first_index));
    const auto offset = static_cast<std::uint32_t>(index - range.first_index);
    return {range.condition, range.shard.TrialAt(range.first_place + offset)};
  }

 private:
  struct Missing {  // a range of missing trials
    std::int64_t first_index = 0;
    std::uint32_t first_place = 0;  // in the shard
    ShardTrials shard;
    const Condition* condition = nullptr;
  };

  std::vector<Missing> missing_;
  std::int64_t num_trials_ = 0, num_missing_ = 0;
};

}  // namespace

RunReport RunTrials(const StudyPlan& plan, const Shard& shard, int num_threads, TrialKeeper* keeper) {
  const auto start = std::chrono::steady_clock::now();
  const TrialsToRun trials(plan, shard, keeper);
  if (trials.num_missing() > 0) {
    CheckProcessEstimators(plan.study.estimators);
    const std::string warning = keeper->NoteOrigin(ThisProgram());
    if (!warning.empty()) PrintMessage("warning: {}\n", warning);
  }
  Progress progress("trials", trials.num_trials(), trials.num_trials() - trials.num_missing());
  OutcomeWatch outcomes;
  FinishItems(trials.num_missing(), num_threads, &progress, keeper, [&](std::int64_t index) {
    const auto [condition, trial] = trials.At(index);
    const TrialResult result = RunTrialOfDraw(plan, *condition, trial);
    keeper->Keep(result);
    outcomes.Add(result);
    return 1;
  });
  keeper->Flush();
  outcomes.Warn(plan, keeper->RecordFile());
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return {trials.num_trials(), trials.num_missing(), elapsed.count()};
}

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
