// Runs the trials of a study, whatever is kept of them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiments/core/work/item_loop.h"
#include "experiments/core/work/shard.h"
#include "experiments/study/run_description.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial.h"
#include "experiments/trial/trial_range.h"

namespace rcme {

// Keeps the results of a run's trials: every record (run/run_study.h), or counts (statistics/count_study.h).
class TrialKeeper : public ItemKeeper {
 public:
  // Returns which of the first `num_trials` trials of a condition belong to the shard and have not been
  // kept, as ascending places in the shard.
  virtual std::vector<TrialRange> MissingTrials(std::uint32_t condition, std::uint32_t num_trials,
                                                const ShardTrials& shard) = 0;
  // Call this before the first new trial is kept. Returns a warning if kept trials have another origin, else
  // an empty text.
  virtual std::string NoteOrigin(const TrialOrigin& origin) = 0;
  // The file with every trial's records; empty: there is none.
  virtual std::string RecordFile() const { return {}; }
  // May be called from any thread.
  virtual void Keep(const TrialResult& result) = 0;
};

struct RunReport {
  std::int64_t num_trials = 0;   // of the study or the shard
  std::int64_t num_run_now = 0;  // the others had been kept before
  double seconds = 0.0;
};

// Runs every trial of the plan, or of one shard, that has not been kept, on `num_threads` threads (0: one
// per core), and shows progress. The records do not depend on the number of threads or on the order in which
// trials finish. Memory does not grow with the number of trials. After an error or Stopped, the trials
// finished so far are kept.
RunReport RunTrials(const StudyPlan& plan, const Shard& shard, int num_threads, TrialKeeper* keeper);

// The work on one trial. `index` counts from 0; each condition has `trials.end - trials.first` consecutive
// indices.
using TrialWork = std::function<void(const Condition& condition, std::uint32_t trial, std::int64_t index)>;

// Calls `work` for the same trial numbers of every condition of a plan. With one thread, the order is that of
// the plan. With several (`num_threads`; 0: one per core), all conditions take turns, because the first trial
// of a condition searches its baseline while the condition's other trials wait. A stop request ends it with
// Stopped.
void ForEachTrial(const StudyPlan& plan, TrialRange trials, const TrialWork& work, int num_threads = 1);

}  // namespace rcme
