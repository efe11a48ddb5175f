// What a study costs beside its estimators: items are trials, or records where the name says so.
//   cmake --build --preset benchmarks && build/release/bin/rcme_benchmark --benchmark_filter=Engine
// Interleave repetitions on a shared machine: --benchmark_repetitions=5
// --benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true

#include <benchmark/benchmark.h>

#include <string>

#include "experiments/statistics/summarize.h"
#include "experiments/run/run_study.h"
#include "tests/benchmarks/engine_fixture.h"
#include "tests/test_support/add_records.h"

namespace rcme {
namespace {

void BM_EngineScore(benchmark::State& state) {
  const StudyPlan plan = EnginePlan(kNoWork, 1);
  const TrialResult trial = RunTrial(plan, plan.conditions[0], 0);
  for (auto _ : state) benchmark::DoNotOptimize(Score(trial.estimates[0], trial.data, 0.0));
}

void BM_EngineRunTrial(benchmark::State& state) {
  const StudyPlan plan = EnginePlan(kNoWork, 1);
  for (auto _ : state) benchmark::DoNotOptimize(RunTrial(plan, plan.conditions[0], 0));
}

void BM_EngineCopyOfData(benchmark::State& state) {
  const StudyPlan plan = EnginePlan(kNoWork, 1);
  for (auto _ : state) benchmark::DoNotOptimize(plan.conditions[0].source->Make({}));
}

void BM_EngineStoreRecords(benchmark::State& state) {
  const StudyPlan plan = EnginePlan(kNoWork, 100'000);
  std::vector<TrialRecord> records = RunTrial(plan, plan.conditions[0], 0).records;
  records.resize(500, records[0]);
  for (auto _ : state) {
    const ScratchFile file;
    ResultStore store = ResultStore::OpenForRun(file.path(), plan);
    for (std::uint32_t trial = 0; trial < 100'000;) {
      for (TrialRecord& record : records) record.trial = trial++;
      AddRecords(store, records);
    }
    store.Commit();
  }
  state.SetItemsProcessed(state.iterations() * 100'000);
}

void BM_EngineRun(benchmark::State& state, const std::string& estimator, int trials) {
  const StudyPlan plan = EnginePlan(estimator, trials / 2);
  for (auto _ : state) RunToScratchFile(plan, static_cast<int>(state.range(0)));
  state.SetItemsProcessed(state.iterations() * trials);
}

// Of this many records.
void BM_EngineSummarizeRecords(benchmark::State& state) {
  const StudyPlan plan = EnginePlan(kNoWork, static_cast<int>(state.range(0)) / 2);
  const ScratchFile file;
  ResultStore store = ResultStore::OpenForRun(file.path(), plan);
  RunStudy(plan, 0, &store);
  for (auto _ : state) benchmark::DoNotOptimize(Summarize(store, false));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(BM_EngineScore);
BENCHMARK(BM_EngineCopyOfData);
BENCHMARK(BM_EngineRunTrial);
BENCHMARK(BM_EngineStoreRecords)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK_CAPTURE(BM_EngineRun, no_work, kNoWork, 200'000)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(BM_EngineRun, 80_us, k80Microseconds, 50'000)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(BM_EngineSummarizeRecords)
    ->ArgName("records")
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace rcme
