#include "experiments/run/run_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <list>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

#include "experiments/statistics/summarize.h"
#include "tests/test_support/add_records.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/peak_memory.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

Study MakeStudy(int trials) {
  Study study = SmallStudy();
  study.trials = trials;
  return study;
}

class RunStudyTest : public testing::Test {
 protected:
  RunReport Run(const std::string& name, const StudyPlan& plan, int num_threads) {
    ResultStore store = ResultStore::OpenForRun(folder_.Path(name), plan);
    return RunStudy(plan, num_threads, &store);
  }
  // Every record of a file, the time aside.
  std::string Records(const std::string& name) {
    std::string text;
    ResultStore::OpenForReading(folder_.Path(name)).ForEachRecord([&](const TrialRecord& record) {
      text += RecordText(record) + "\n";
    });
    return text;
  }

  TempFolder folder_;
};

// Data that take no time and tell the trials apart by the noise level.
class QuickData : public DataSource {
 public:
  int NumTrials(int trials) const override { return trials; }
  TrialData Make(const StreamName& name) const override {
    TrialData data;
    data.problem.sigma_px = name.trial + 0.1 * static_cast<double>(name.condition % 97);
    return data;
  }
};

// Answers at once, with a number that tells which problem it was.
class QuickEstimator : public MotionEstimator {
 public:
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream&) const override {
    MotionEstimate estimate;
    estimate.status = MotionStatus::kOk;
    estimate.num_support = 1;
    estimate.mean_entropy = problem.sigma_px;
    return estimate;
  }
};

StudyPlan QuickPlan(int trials) {
  StudyPlan plan = MakePlan(MakeStudy(trials));
  for (Condition& condition : plan.conditions) condition.source = std::make_shared<QuickData>();
  for (auto& estimator : plan.estimators) estimator = std::make_shared<QuickEstimator>();
  return plan;
}

TEST_F(RunStudyTest, ThreadsChangeNothing) {
  const StudyPlan plan = MakePlan(MakeStudy(21));
  const RunReport report = Run("one", plan, 1);
  EXPECT_EQ(report.num_trials, 42);
  EXPECT_EQ(report.num_run_now, 42);
  const std::string records = Records("one");
  EXPECT_EQ(std::count(records.begin(), records.end(), '\n'), 2 * 42);
  for (const int num_threads : {2, 5, 0}) {
    const std::string name = "threads" + std::to_string(num_threads);
    Run(name, plan, num_threads);
    EXPECT_EQ(Records(name), records) << num_threads << " threads";
  }
}

TEST_F(RunStudyTest, RecordsAreThoseOfRunTrial) {
  const StudyPlan plan = MakePlan(MakeStudy(3));
  Run("run", plan, 2);
  std::string expected;
  for (const Condition& condition : plan.conditions) {
    for (std::uint32_t trial = 0; trial < 3; ++trial) {
      for (const TrialRecord& record : RunTrial(plan, condition, trial).records)
        expected += RecordText(record) + "\n";
    }
  }
  EXPECT_EQ(Records("run"), expected);
}

TEST_F(RunStudyTest, ResumingGivesTheSame) {
  const StudyPlan plan = MakePlan(MakeStudy(20));
  Run("whole", plan, 1);
  {  // what a run leaves that was cut off: some trials, with gaps
    ResultStore store = ResultStore::OpenForRun(folder_.Path("resumed"), plan);
    for (const std::uint32_t trial : {0u, 1u, 7u, 13u})
      AddRecords(store, RunTrial(plan, plan.conditions[0], trial).records);
    AddRecords(store, RunTrial(plan, plan.conditions[1], 19).records);
  }
  const RunReport report = Run("resumed", plan, 2);
  EXPECT_EQ(report.num_trials, 40);
  EXPECT_EQ(report.num_run_now, 35);
  EXPECT_EQ(Records("resumed"), Records("whole"));
  EXPECT_EQ(Run("resumed", plan, 2).num_run_now, 0);
  EXPECT_EQ(Records("resumed"), Records("whole"));
}

// Long enough for several writes and commits: a trial takes some microseconds.
TEST_F(RunStudyTest, ThreadsAndGapsChangeNothingOfManyQuickTrials) {
  const StudyPlan plan = QuickPlan(10'000);
  EXPECT_EQ(Run("one", plan, 1).num_run_now, 20'000);
  const std::string records = Records("one");
  EXPECT_EQ(std::count(records.begin(), records.end(), '\n'), 2 * 20'000);
  Run("five", plan, 5);
  EXPECT_TRUE(Records("five") == records) << "five threads";
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("gaps"), plan);
    for (std::uint32_t trial = 0; trial < 10'000; trial += 7) {
      AddRecords(store, RunTrial(plan, plan.conditions[trial % 2], trial).records);
    }
  }
  EXPECT_EQ(Run("gaps", plan, 2).num_run_now, 20'000 - 1'429);
  EXPECT_TRUE(Records("gaps") == records) << "resumed";
}

// An estimator that keeps a little of every trial, as a leak would.
class HoardingEstimator : public QuickEstimator {
 public:
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    const std::lock_guard lock(mutex_);
    hoard_.emplace_back().fill(1);
    return QuickEstimator::Estimate(problem, rng);
  }

 private:
  mutable std::mutex mutex_;
  mutable std::list<std::array<char, 104>> hoard_;  // 128 bytes each, on the heap; a record has 170
};

TEST_F(RunStudyTest, TenTimesTheTrialsNeedNoMoreMemory) {
  if (!CanMeasurePeakMemory()) GTEST_SKIP() << "this system or build does not tell the peak memory";
  constexpr int kTrials = 10'000;
  constexpr double kBoundMb = 8.0;  // 44 bytes for each of the 180,000 trials more; a record alone has 170
  StudyPlan few = QuickPlan(kTrials), many = QuickPlan(10 * kTrials), hoarding = QuickPlan(10 * kTrials);
  const auto run = [&](const std::string& name, const StudyPlan& plan) {
    return PeakMemoryMb([&] { Run(name, plan, 2); });
  };
  run("warm", few);
  const double few_mb = run("few", few), many_mb = run("many", many);
  EXPECT_LT(many_mb - few_mb, kBoundMb) << few_mb << " MB, then " << many_mb << " MB";
  hoarding.estimators[0] = std::make_shared<HoardingEstimator>();
  EXPECT_GT(run("hoarding", hoarding) - few_mb, kBoundMb) << "the measurement would not see a leak";

  const auto summarize = [&](const std::string& name) {
    return PeakMemoryMb([&] { Summarize(ResultStore::OpenForReading(folder_.Path(name)), false); });
  };
  EXPECT_LT(summarize("many") - summarize("few"), kBoundMb);
}

TEST_F(RunStudyTest, MoreTrialsExtendARun) {
  Run("whole", MakePlan(MakeStudy(20)), 1);
  EXPECT_EQ(Run("extended", MakePlan(MakeStudy(5)), 1).num_run_now, 10);
  EXPECT_EQ(Run("extended", MakePlan(MakeStudy(20)), 1).num_run_now, 30);
  EXPECT_EQ(Records("extended"), Records("whole"));
  EXPECT_EQ(Run("extended", MakePlan(MakeStudy(5)), 1).num_run_now, 0);
  EXPECT_EQ(Records("extended"), Records("whole")) << "fewer trials than before must lose none";
}

TEST_F(RunStudyTest, AnImpossibleSceneArrivesAsInputErrorAndWhatWasDoneIsKept) {
  Study study = MakeStudy(20);
  study.factors = {{"baseline_m", {"1", "1e6"}}};  // from a baseline of 1,000 km image 2 sees nothing
  const StudyPlan plan = MakePlan(study);
  for (const int num_threads : {1, 2}) {
    const std::string name = "run" + std::to_string(num_threads);
    EXPECT_TRUE(
        ThrowsInputError([&] { Run(name, plan, num_threads); }, {"both images see only", "baseline_m"}));
    ResultStore store = ResultStore::OpenForRun(folder_.Path(name), plan);
    EXPECT_TRUE(store.MissingTrials(0, 20).empty()) << "what was done before the error is lost";
    ASSERT_EQ(store.MissingTrials(1, 20).size(), 1u);
    EXPECT_EQ(store.MissingTrials(1, 20)[0].end - store.MissingTrials(1, 20)[0].first, 20u);
  }
}

// Fails, with an error that is nobody's input.
class FailingData : public DataSource {
 public:
  int NumTrials(int trials) const override { return trials; }
  TrialData Make(const StreamName&) const override { throw std::runtime_error("out of order"); }
};

TEST_F(RunStudyTest, OtherErrorsArriveAsTheyAre) {
  StudyPlan plan = MakePlan(MakeStudy(20));
  plan.conditions[1].source = std::make_shared<FailingData>();
  EXPECT_THROW(Run("run", plan, 2), std::runtime_error);
  EXPECT_NO_THROW(Records("run"));
}

}  // namespace
}  // namespace rcme
