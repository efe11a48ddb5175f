// What a study costs beside its estimators: items are trials, or records where the name says so.
//   cmake --build --preset benchmarks && build/release/bin/rcme_benchmark --benchmark_filter=Engine
// Interleave repetitions on a shared machine: --benchmark_repetitions=5
// --benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true

#include <benchmark/benchmark.h>

#include <filesystem>
#include <memory>
#include <string>

#include "estimator/estimator_registry.h"
#include "experiments/run_study.h"
#include "experiments/study_file.h"
#include "experiments/summarize.h"

namespace rcme {
namespace {

// Answers the same motion for every problem, after a fixed amount of arithmetic in registers.
class FixedAnswer : public MotionEstimator {
 public:
  explicit FixedAnswer(int num_steps) : num_steps_(num_steps) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream&) const override {
    std::uint64_t word = problem.matches.size();
    for (int i = 0; i < num_steps_; ++i) word = word * 6364136223846793005U + 1442695040888963407U;
    benchmark::DoNotOptimize(word);
    MotionEstimate estimate;
    estimate.status = MotionStatus::kOk;
    estimate.pose_cov = Matrix5d::Identity() * 1e-4;
    for (int i = 0; i < static_cast<int>(problem.matches.size()); i += 2) estimate.inliers.push_back(i);
    return estimate;
  }

 private:
  int num_steps_;
};

// Hands out copies of one trial's data.
class FixedData : public DataSource {
 public:
  explicit FixedData(TrialData data) : data_(std::move(data)) {}
  int NumTrials(int trials) const override { return trials; }
  TrialData Make(const StreamName&) const override { return data_; }

 private:
  TrialData data_;
};

constexpr const char* kNoWork = "no_work";
constexpr const char* k80Microseconds = "80_us";  // or thereabouts

void AddEstimators() {
  static const bool once = [] {
    for (const auto& [name, num_steps] : {std::pair{kNoWork, 0}, {k80Microseconds, 47'000}}) {
      const int steps = num_steps;
      AddEstimator({name, "answers the same motion for every problem",
                    [steps](const RansacOptions&) { return std::make_unique<FixedAnswer>(steps); }});
    }
    return true;
  }();
  benchmark::DoNotOptimize(once);
}

// Two conditions with the same 500 matches.
StudyPlan PlanOf(const std::string& estimator, int trials) {
  AddEstimators();
  StudyPlan plan = MakePlan(
      ParseStudy("name: engine\nseed: 1\ntrials: " + std::to_string(trials) +
                     "\ndata: {scene: uniform_volume, num_matches: 500}\nfactors:\n  outlier_ratio: [0.0, "
                     "0.3]\nestimators:\n  - {name: " +
                     estimator + "}\n",
                 "engine"));
  const auto data = std::make_shared<FixedData>(plan.conditions[1].source->Make({1, 1, 0, 0}));
  for (Condition& condition : plan.conditions) condition.source = data;
  return plan;
}

// A result file that does not exist yet and is gone in the end.
class ScratchFile {
 public:
  ScratchFile() { std::filesystem::remove(path_); }
  ~ScratchFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_ = (std::filesystem::temp_directory_path() / "rcme_engine_benchmark.sqlite").string();
};

void BM_EngineScore(benchmark::State& state) {
  const StudyPlan plan = PlanOf(kNoWork, 1);
  const TrialResult trial = RunTrial(plan, plan.conditions[0], 0);
  for (auto _ : state) benchmark::DoNotOptimize(Score(trial.estimates[0], trial.data, 0.0));
}

void BM_EngineRunTrial(benchmark::State& state) {
  const StudyPlan plan = PlanOf(kNoWork, 1);
  for (auto _ : state) benchmark::DoNotOptimize(RunTrial(plan, plan.conditions[0], 0));
}

void BM_EngineCopyOfData(benchmark::State& state) {
  const StudyPlan plan = PlanOf(kNoWork, 1);
  for (auto _ : state) benchmark::DoNotOptimize(plan.conditions[0].source->Make({}));
}

void BM_EngineStoreRecords(benchmark::State& state) {
  const StudyPlan plan = PlanOf(kNoWork, 100'000);
  std::vector<TrialRecord> records = RunTrial(plan, plan.conditions[0], 0).records;
  records.resize(500, records[0]);
  for (auto _ : state) {
    const ScratchFile file;
    ResultStore store = ResultStore::OpenForRun(file.path(), plan);
    for (std::uint32_t trial = 0; trial < 100'000;) {
      for (TrialRecord& record : records) record.trial = trial++;
      store.Add(records);
    }
    store.Commit();
  }
  state.SetItemsProcessed(state.iterations() * 100'000);
}

void BM_EngineRun(benchmark::State& state, const std::string& estimator, int trials) {
  const StudyPlan plan = PlanOf(estimator, trials / 2);
  for (auto _ : state) {
    const ScratchFile file;
    ResultStore store = ResultStore::OpenForRun(file.path(), plan);
    RunStudy(plan, static_cast<int>(state.range(0)), &store);
  }
  state.SetItemsProcessed(state.iterations() * trials);
}

// Of this many records.
void BM_EngineSummarizeRecords(benchmark::State& state) {
  const StudyPlan plan = PlanOf(kNoWork, static_cast<int>(state.range(0)) / 2);
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
