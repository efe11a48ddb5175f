#include "tests/benchmarks/engine_fixture.h"

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "estimator/estimator_registry.h"
#include "experiments/run/run_study.h"
#include "experiments/study/study_file.h"

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

class FixedAnswerModel : public EstimatorModel {
 public:
  explicit FixedAnswerModel(int num_steps) : num_steps_(num_steps) {}
  std::unique_ptr<MotionEstimator> Make() const override { return std::make_unique<FixedAnswer>(num_steps_); }

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

void AddEstimators() {
  static const bool once = [] {
    for (const auto& [name, num_steps] : {std::pair{kNoWork, 0}, {k80Microseconds, 47'000}}) {
      const int steps = num_steps;
      AddEstimator({name, "answers the same motion for every problem",
                    [steps] { return std::make_unique<FixedAnswerModel>(steps); }});
    }
    return true;
  }();
  benchmark::DoNotOptimize(once);
}

}  // namespace

StudyPlan EnginePlan(const std::string& estimator, int trials_per_condition) {
  AddEstimators();
  StudyPlan plan = MakePlan(
      ParseStudy("name: engine\nseed: 1\ntrials: " + std::to_string(trials_per_condition) +
                     "\ndata: {scene: uniform_volume, num_matches: 500}\nfactors:\n  outlier_ratio: [0.0, "
                     "0.3]\nestimators:\n  - {name: " +
                     estimator + "}\n",
                 "engine"));
  const auto data = std::make_shared<FixedData>(plan.conditions[1].source->Make({1, 1, 0, 0}));
  for (Condition& condition : plan.conditions) condition.source = data;
  return plan;
}

ScratchFile::ScratchFile() {
  const std::filesystem::path memory = "/dev/shm";
  const auto folder = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
  path_ = (folder / ("rcme_benchmark_" + std::to_string(getpid()) + ".sqlite")).string();
  std::filesystem::remove(path_);
}
ScratchFile::~ScratchFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void RunToScratchFile(const StudyPlan& plan, int num_threads) {
  const ScratchFile file;
  ResultStore store = ResultStore::OpenForRun(file.path(), plan);
  RunStudy(plan, num_threads, &store);
}

}  // namespace rcme
