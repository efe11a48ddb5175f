#include "experiments/run/run_study.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <mutex>

#include "experiments/core/text/message.h"
#include "experiments/core/work/progress.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/run/for_each_trial.h"
#include "experiments/run/refusal_watch.h"

namespace rcme {
namespace {

using Clock = std::chrono::steady_clock;

struct TrialsToRun {
  std::vector<TrialsOfCondition> missing;  // in the store, in the plan's order
  std::int64_t num_trials = 0;             // with those that it holds
};

TrialsToRun FindTrialsToRun(const StudyPlan& plan, const Shard& shard, ResultStore* store) {
  TrialsToRun found;
  for (const Condition& condition : plan.conditions) {
    const auto num_trials = static_cast<std::uint32_t>(condition.num_trials);
    const ShardTrials trials(shard, condition.index, plan.study.repeats_per_scene);
    found.num_trials += trials.NumBefore(num_trials);
    for (const TrialRange& range : store->MissingTrials(condition.index, num_trials, trials))
      found.missing.push_back({&condition, range, trials});
  }
  return found;
}

// Collects the records of finished trials; from time to time one thread writes them, while the others go on.
class RecordBuffer {
 public:
  explicit RecordBuffer(ResultStore* store) : store_(store) {}

  // The records of a whole trial.
  void Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    const Clock::time_point now = Clock::now();
    size_t num_waiting = 0;
    {
      const std::lock_guard lock(waiting_mutex_);
      waiting_.problems.push_back(problem);
      waiting_.trials.insert(waiting_.trials.end(), records.begin(), records.end());
      num_waiting = waiting_.trials.size();
      if (now < next_write_ && num_waiting < kMaxWaiting) return;
    }
    std::unique_lock writing(writing_mutex_, std::try_to_lock);
    if (!writing && num_waiting < kMaxWaiting) return;  // another thread writes
    if (!writing) writing.lock();                       // ... but not fast enough
    Write();
  }

  // Writes what is left.
  void Flush() {
    const std::lock_guard writing(writing_mutex_);
    Write();
    store_->Commit();
  }

 private:
  static constexpr std::chrono::milliseconds kWriteInterval{50};
  static constexpr size_t kMaxWaiting = 4'000;

  void Write() {
    {
      const std::lock_guard lock(waiting_mutex_);
      written_.problems.clear();
      written_.trials.clear();
      std::swap(written_, waiting_);
      next_write_ = Clock::now() + kWriteInterval;
    }
    store_->Add(written_.problems, written_.trials);
  }

  struct Records {
    std::vector<ProblemRecord> problems;
    std::vector<TrialRecord> trials;
  };

  ResultStore* store_;
  std::mutex waiting_mutex_;  // of waiting_ and next_write_
  Records waiting_;
  Clock::time_point next_write_ = Clock::now() + kWriteInterval;
  std::mutex writing_mutex_;  // of written_
  Records written_;
};

}  // namespace

RunReport RunStudy(const StudyPlan& plan, int num_threads, ResultStore* store, const Shard& shard) {
  const Clock::time_point start = Clock::now();
  const TrialsToRun trials = FindTrialsToRun(plan, shard, store);
  const std::int64_t num_to_run = NumTrials(trials.missing), num_before = trials.num_trials - num_to_run;
  if (num_to_run > 0) {
    CheckProcessEstimators(plan.study.estimators);
    const std::string warning = store->NoteOrigin(ThisProgram());
    if (!warning.empty()) PrintMessage("warning: {}\n", warning);
  }
  Progress progress("trials", trials.num_trials, num_before);
  RecordBuffer buffer(store);
  RefusalWatch refusals;
  std::atomic<std::int64_t> num_done = num_before;
  try {
    ForEachTrial(trials.missing, num_threads, &progress,
                 [&](const Condition& condition, std::uint32_t trial, std::int64_t) {
                   const TrialResult result = RunTrial(plan, condition, trial);
                   buffer.Add(result.problem, result.records);
                   refusals.Add(result.records);
                   ++num_done;
                 });
  } catch (const Stopped&) {
    buffer.Flush();
    throw Stopped(fmt::format("stopped, {} trials kept; the same command resumes", num_done.load()));
  } catch (...) {
    buffer.Flush();  // the trials before the error are good
    throw;
  }
  buffer.Flush();
  refusals.WarnOfRefusals(plan.study.estimators);
  const std::chrono::duration<double> elapsed = Clock::now() - start;
  return {trials.num_trials, num_to_run, elapsed.count()};
}

}  // namespace rcme
