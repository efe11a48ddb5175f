#include "experiments/run_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

Study StudyOf(int trials) {
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

TEST_F(RunStudyTest, ThreadsChangeNothing) {
  const StudyPlan plan = MakePlan(StudyOf(21));
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
  const StudyPlan plan = MakePlan(StudyOf(3));
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
  const StudyPlan plan = MakePlan(StudyOf(20));
  Run("whole", plan, 1);
  {  // what a run leaves that was cut off: some trials, with gaps
    ResultStore store = ResultStore::OpenForRun(folder_.Path("resumed"), plan);
    for (const std::uint32_t trial : {0u, 1u, 7u, 13u})
      store.Add(RunTrial(plan, plan.conditions[0], trial).records);
    store.Add(RunTrial(plan, plan.conditions[1], 19).records);
  }
  const RunReport report = Run("resumed", plan, 2);
  EXPECT_EQ(report.num_trials, 40);
  EXPECT_EQ(report.num_run_now, 35);
  EXPECT_EQ(Records("resumed"), Records("whole"));
  EXPECT_EQ(Run("resumed", plan, 2).num_run_now, 0);
  EXPECT_EQ(Records("resumed"), Records("whole"));
}

TEST_F(RunStudyTest, MoreTrialsExtendARun) {
  Run("whole", MakePlan(StudyOf(20)), 1);
  EXPECT_EQ(Run("extended", MakePlan(StudyOf(5)), 1).num_run_now, 10);
  EXPECT_EQ(Run("extended", MakePlan(StudyOf(20)), 1).num_run_now, 30);
  EXPECT_EQ(Records("extended"), Records("whole"));
  EXPECT_EQ(Run("extended", MakePlan(StudyOf(5)), 1).num_run_now, 0);
  EXPECT_EQ(Records("extended"), Records("whole")) << "fewer trials than before must lose none";
}

TEST_F(RunStudyTest, AnImpossibleSceneArrivesAsInputErrorAndWhatWasDoneIsKept) {
  Study study = StudyOf(20);
  study.factors = {{"baseline_m", {"1", "1e6"}}};  // from a baseline of 1,000 km image 2 sees nothing
  const StudyPlan plan = MakePlan(study);
  for (const int num_threads : {1, 2}) {
    const std::string name = "run" + std::to_string(num_threads);
    EXPECT_TRUE(ThrowsInputError([&] { Run(name, plan, num_threads); }, {"image 2 sees only", "baseline_m"}));
    ResultStore store = ResultStore::OpenForRun(folder_.Path(name), plan);
    const size_t num_missing = store.MissingTrials(0, 0, 20).size();
    EXPECT_LT(num_missing, 20u) << "what was done before the error is lost";
    EXPECT_EQ(num_missing % 4, 0u) << "half a batch was written";
    EXPECT_EQ(store.MissingTrials(1, 0, 20).size(), 20u);
  }
}

// Fails, with an error that is nobody's input.
class FailingData : public DataSource {
 public:
  int NumTrials(int trials) const override { return trials; }
  TrialData Make(const StreamName&) const override { throw std::runtime_error("out of order"); }
};

TEST_F(RunStudyTest, OtherErrorsArriveAsTheyAre) {
  StudyPlan plan = MakePlan(StudyOf(20));
  plan.conditions[1].source = std::make_shared<FailingData>();
  EXPECT_THROW(Run("run", plan, 2), std::runtime_error);
  EXPECT_NO_THROW(Records("run"));
}

}  // namespace
}  // namespace rcme
