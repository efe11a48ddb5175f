#include "experiments/run_study.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>

#include "experiments/progress.h"

namespace rcme {
namespace {

// Trials of one condition that a thread runs before it asks for more.
struct Batch {
  const Condition* condition = nullptr;
  std::uint32_t num_in_range = 0;  // with those that were in the store already
  std::vector<std::uint32_t> trials;
};

constexpr std::uint32_t kTrialsPerBatch = 8;

// Hands out the plan's missing trials batch by batch and takes in their records. Every call holds the one
// lock, so each thread has one batch in hand and memory does not grow.
class Ledger {
 public:
  Ledger(const StudyPlan& plan, ResultStore* store)
      : plan_(plan), store_(store), progress_("trials", plan.NumTrials()) {}

  // Nothing left, or stopped: nullopt.
  std::optional<Batch> Next() {
    const std::lock_guard lock(mutex_);
    while (!is_stopped_ && condition_ < plan_.conditions.size()) {
      const Condition& condition = plan_.conditions[condition_];
      const auto end = static_cast<std::uint32_t>(condition.num_trials);
      if (first_ >= end) {
        ++condition_;
        first_ = 0;
        continue;
      }
      const std::uint32_t last = first_ + std::min(kTrialsPerBatch, end - first_);
      Batch batch{&condition, last - first_, store_->MissingTrials(condition.index, first_, last)};
      first_ = last;
      return batch;
    }
    return std::nullopt;
  }

  void TakeIn(const Batch& batch, const std::vector<TrialRecord>& records) {
    const std::lock_guard lock(mutex_);
    if (!records.empty()) store_->Add(records);
    num_run_ += static_cast<std::int64_t>(batch.trials.size());
    progress_.Advance(batch.num_in_range);
  }

  // No more batches: a thread has failed.
  void Stop() {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
  }

  std::int64_t num_run() {
    const std::lock_guard lock(mutex_);
    return num_run_;
  }

 private:
  std::mutex mutex_;
  const StudyPlan& plan_;
  ResultStore* store_;
  Progress progress_;
  size_t condition_ = 0;
  std::uint32_t first_ = 0;
  std::int64_t num_run_ = 0;
  bool is_stopped_ = false;
};

// One thread's work, to the end of the study.
void RunBatches(const StudyPlan& plan, Ledger* ledger) {
  try {
    while (const std::optional<Batch> batch = ledger->Next()) {
      std::vector<TrialRecord> records;
      for (const std::uint32_t trial : batch->trials) {
        const TrialResult result = RunTrial(plan, *batch->condition, trial);
        records.insert(records.end(), result.records.begin(), result.records.end());
      }
      ledger->TakeIn(*batch, records);
    }
  } catch (...) {
    ledger->Stop();
    throw;
  }
}

}  // namespace

RunReport RunStudy(const StudyPlan& plan, int num_threads, ResultStore* store) {
  const auto start = std::chrono::steady_clock::now();
  const int threads = num_threads > 0 ? num_threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  Ledger ledger(plan, store);
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(
        0, threads, [&](int) { RunBatches(plan, &ledger); }, tbb::simple_partitioner());
  });
  store->Commit();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return {plan.NumTrials(), ledger.num_run(), elapsed.count()};
}

}  // namespace rcme
