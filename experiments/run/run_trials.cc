#include "experiments/run/run_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "experiments/core/text/message.h"
#include "experiments/core/work/for_each_index.h"
#include "experiments/run/store/result_store.h"
#include "experiments/trial/trial.h"

namespace rcme {
namespace {

// Warnings that matter before the tables of a run are read: an estimator gave no valid answer in any trial,
// which suggests that it or its set-up is broken; trials could not be simulated. Add may be called from any
// thread.
class OutcomeWatch {
 public:
  void Add(const TrialResult& result);
  // Prints to standard error: a warning for each estimator of the plan whose answers are all refusals or
  // invalid, and one with the number of trials that were not simulated and the reason of the first.
  void Warn(const StudyPlan& plan) const;

 private:
  void WarnOfNoAnswers(const StudyPlan& plan) const;
  void WarnOfNotSimulated(const StudyPlan& plan) const;

  // The trials of one condition that were not simulated.
  struct NotSimulatedTrials {
    std::int64_t count = 0;
    std::uint32_t first = 0;
    std::string why;  // reason of the first
  };

  mutable std::mutex mutex_;
  std::int64_t num_simulated_ = 0, num_not_simulated_ = 0;
  // By estimator: the number of each status except ok.
  std::vector<std::map<MotionStatus, std::int64_t>> no_answers_;
  std::map<std::uint32_t, NotSimulatedTrials> not_simulated_;  // by condition
};

void OutcomeWatch::Add(const TrialResult& result) {
  const std::lock_guard lock(mutex_);
  no_answers_.resize(result.records.size());
  if (!result.why_not_simulated.empty()) {
    ++num_not_simulated_;
    NotSimulatedTrials& of_condition = not_simulated_[result.problem.condition];
    const std::uint32_t trial = result.problem.trial;
    if (of_condition.count == 0 || trial < of_condition.first)
      of_condition = {of_condition.count, trial, result.why_not_simulated};
    ++of_condition.count;
    return;
  }
  if (!IsCounted(result.records.front())) return;
  ++num_simulated_;
  for (size_t e = 0; e < result.records.size(); ++e) {
    if (const MotionStatus status = result.records[e].status; status != MotionStatus::kOk)
      ++no_answers_[e][status];
  }
}

void OutcomeWatch::Warn(const StudyPlan& plan) const {
  const std::lock_guard lock(mutex_);
  WarnOfNoAnswers(plan);
  WarnOfNotSimulated(plan);
}

void OutcomeWatch::WarnOfNoAnswers(const StudyPlan& plan) const {
  if (num_simulated_ == 0) return;
  for (size_t e = 0; e < no_answers_.size(); ++e) {
    std::int64_t num_unanswered = 0;
    bool is_invalid_somewhere = false;
    std::vector<std::string> counts;
    for (const auto& [status, count] : no_answers_[e]) {
      num_unanswered += count;
      is_invalid_somewhere |=
          status == MotionStatus::kInvalidMotion || status == MotionStatus::kInvalidCovariance;
      counts.push_back(fmt::format("{} {}", StatusName(status), count));
    }
    if (num_unanswered < num_simulated_) continue;
    PrintMessage(
        "warning: {} {} of the {} trials run now ({}); rcme replay FILE --condition 0 --trial 0 shows why\n",
        plan.study.estimators.at(e).label,
        is_invalid_somewhere ? "gave no valid answer in any" : "refused every one", num_simulated_,
        fmt::join(counts, ", "));
  }
}

void OutcomeWatch::WarnOfNotSimulated(const StudyPlan& plan) const {
  if (not_simulated_.empty()) return;
  size_t num_whole = 0;
  for (const auto& [condition, trials] : not_simulated_)
    num_whole += trials.count == plan.conditions.at(condition).num_trials;
  const auto& [condition, example] = *not_simulated_.begin();
  PrintMessage(
      "warning: {} of the {} trials run now could not be simulated: in {} of {} conditions, in {} of them "
      "all. "
      "They are kept as {}, and no other rate counts them. Condition {}, trial {}: {}\n",
      num_not_simulated_, num_not_simulated_ + num_simulated_, not_simulated_.size(), plan.conditions.size(),
      num_whole, StatusName(MotionStatus::kNotSimulated), condition, example.first, example.why);
}

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
  outcomes.Warn(plan);
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
