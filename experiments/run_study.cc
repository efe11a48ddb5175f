#include "experiments/run_study.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>

#include "experiments/progress.h"

namespace rcme {
namespace {

// Trials of one condition that one task runs.
struct Batch {
  const Condition* condition = nullptr;
  std::uint32_t num_in_range = 0;  // with those that were in the store already
  std::vector<std::uint32_t> trials;
  std::vector<TrialRecord> records;
};

constexpr std::uint32_t kTrialsPerBatch = 8;

// Hands out the plan's missing trials, batch by batch.
class BatchSource {
 public:
  BatchSource(const StudyPlan& plan, ResultStore* store) : plan_(plan), store_(store) {}

  std::optional<Batch> Next() {
    while (condition_ < plan_.conditions.size()) {
      const Condition& condition = plan_.conditions[condition_];
      const auto end = static_cast<std::uint32_t>(condition.num_trials);
      if (first_ >= end) {
        ++condition_;
        first_ = 0;
        continue;
      }
      const std::uint32_t last = std::min(first_ + kTrialsPerBatch, end);
      Batch batch{&condition, last - first_, store_->MissingTrials(condition.index, first_, last), {}};
      first_ = last;
      return batch;
    }
    return std::nullopt;
  }

 private:
  const StudyPlan& plan_;
  ResultStore* store_;
  size_t condition_ = 0;
  std::uint32_t first_ = 0;
};

void RunBatch(const StudyPlan& plan, Batch* batch) {
  for (const std::uint32_t trial : batch->trials) {
    const TrialResult result = RunTrial(plan, *batch->condition, trial);
    batch->records.insert(batch->records.end(), result.records.begin(), result.records.end());
  }
}

}  // namespace

RunReport RunStudy(const StudyPlan& plan, int num_threads, ResultStore* store) {
  const auto start = std::chrono::steady_clock::now();
  const int threads = num_threads > 0 ? num_threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  RunReport report{plan.NumTrials(), 0, 0.0};
  Progress progress("trials", report.num_trials);
  BatchSource source(plan, store);

  const auto next = [&](tbb::flow_control& control) {
    std::optional<Batch> batch = source.Next();
    if (!batch) control.stop();
    return batch ? std::move(*batch) : Batch{};
  };
  const auto run = [&](Batch batch) {
    RunBatch(plan, &batch);
    return batch;
  };
  const auto write = [&](const Batch& batch) {
    if (!batch.records.empty()) store->Add(batch.records);
    report.num_run_now += static_cast<std::int64_t>(batch.trials.size());
    progress.Advance(batch.num_in_range);
  };
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_pipeline(static_cast<size_t>(4 * threads),
                           tbb::make_filter<void, Batch>(tbb::filter_mode::serial_in_order, next) &
                               tbb::make_filter<Batch, Batch>(tbb::filter_mode::parallel, run) &
                               tbb::make_filter<Batch, void>(tbb::filter_mode::serial_out_of_order, write));
  });
  store->Commit();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace rcme
