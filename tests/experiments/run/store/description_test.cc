// A result file explains itself: no estimator, no data and no YAML are needed to read it.
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "experiments/data/match_file.h"
#include "experiments/run/run_study.h"
#include "experiments/run/store/new_trials.h"
#include "experiments/statistics/compare.h"
#include "experiments/statistics/report_data.h"
#include "experiments/statistics/summary_output.h"
#include "experiments/statistics/trial_table.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

std::string FormatDescription(const RunDescription& run) {
  std::string text =
      fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}\n", run.study, run.description, run.ademp,
                  run.seed, run.trials, run.repeats_per_scene, run.failure.max_rotation_error_deg,
                  run.failure.max_direction_error_deg, run.factors, run.study_yaml, run.identity,
                  run.stopping_rule, run.until_options, run.origin.program, run.origin.instruction_set);
  text += fmt::format("{} {} {}\n", run.retried_trials, run.lock, run.despite_lock);
  for (const DescribedCondition& condition : run.conditions)
    text += fmt::format("{} {}\n", condition.levels, condition.num_trials);
  for (const DescribedEstimator& estimator : run.estimators)
    text += fmt::format("{} {} {}\n", estimator.label, estimator.name, estimator.options);
  return text;
}

class Description : public testing::Test {
 protected:
  TempFolder folder_;
  std::string path_ = folder_.Path("run.sqlite");
};

TEST_F(Description, ComesBackAsItWasWritten) {
  Study study = SmallStudy();
  study.description = "What, 'in\nwords'?";
  study.ademp = Ademp{"aims", "data", "", "methods", "performance"};
  study.failure = {1.0 / 3.0, 7.0};
  study.repeats_per_scene = 3;
  study.factors.push_back({"sigma_px", {"0.5", "1", "2"}});
  RunDescription run = Describe(MakePlan(study));
  EXPECT_EQ(run.conditions.size(), 6u);
  EXPECT_EQ(run.NumTrials(), 36);
  EXPECT_EQ(run.estimators[1].label, "ours");
  EXPECT_EQ(run.estimators[1].name, "rcme");
  EXPECT_GT(run.estimators[1].options.size(), 5u);
  run.origin = {"rcme 1", "AVX2"};
  run.until_options = "--until ci=0.1";
  run.retried_trials = 17;
  run.lock = "sha256: 1\ntext: |2\n  name: small\n";
  run.despite_lock = "one reason\nanother";
  NewTrials(path_, run).Finish(run);
  EXPECT_EQ(FormatDescription(ResultStore::OpenForReading(path_).Description()), FormatDescription(run));
  EXPECT_TRUE(ThrowsInputError([&] { NewTrials(path_, run); }, {path_, "exists already"}));
}

// A merge adds those of its parts: the sum of any parts that there can be is an integer.
TEST_F(Description, MoreTrialsRunAgainThanThereCanBeAreRefused) {
  RunDescription run = Describe(MakePlan(SmallStudy()));
  run.retried_trials = std::numeric_limits<std::int64_t>::max();
  NewTrials(path_, run).Finish(run);
  EXPECT_TRUE(ThrowsInputError([&] { ResultStore::OpenForReading(path_); },
                               {path_, "'retried_trials' of table run is not possible"}));
}

// Of a program that knows other estimators and other scenes, with a study that this one cannot read.
TEST_F(Description, ResultsOfUnknownEstimatorsAreRead) {
  RunDescription run = Describe(MakePlan(SmallStudy()));
  run.study_yaml = "no: study: at all";
  run.identity = "of another program";
  run.factors = {"phase_of_the_moon"};
  run.estimators[1] = {"theirs", "estimator_of_theirs", "", {{"option_of_theirs", "many"}}};
  {
    NewTrials store(path_, run);
    std::vector<TrialRecord> records(2);
    records[1].estimator = 1;
    store.Add({ProblemRecord(), records, 0});
    store.Finish(run);
  }
  const ResultStore store = ResultStore::OpenForReading(path_);
  EXPECT_NE(SummaryAsCsv(Summarize(store, false)).find("phase_of_the_moon,estimator"), std::string::npos);
  EXPECT_EQ(Compare(store, "theirs").reference, "theirs");
  EXPECT_EQ(store.Description().estimators[1].options, run.estimators[1].options);
  WriteReportData(path_, "", folder_.path());
  EXPECT_TRUE(std::filesystem::exists(folder_.Path("run.json")));
  EXPECT_TRUE(ThrowsInputError([&] { store.Plan(); }, {path_}));
}

// A result file of somebody's, whose checksums are right: with a number beyond those of trials a merge would
// never end.
TEST_F(Description, NumbersOfTrialsThatCannotBeAreRefused) {
  for (const std::int64_t num_trials : {std::int64_t{1} << 33, std::int64_t{1} << 31, std::int64_t{-1}}) {
    RunDescription run = Describe(MakePlan(SmallStudy()));
    run.conditions[1].num_trials = num_trials;
    std::filesystem::remove(path_);
    NewTrials(path_, run).Finish(run);
    EXPECT_TRUE(ThrowsInputError([&] { ResultStore::OpenForReading(path_); },
                                 {path_, "a number of trials that is not possible"}))
        << num_trials;
  }
}

// A result file of somebody's: its checksums are right, and its names would clear the screen.
TEST_F(Description, NamesWithControlCharactersAreRefused) {
  const auto refuses = [&](const std::function<void(RunDescription*)>& change) {
    RunDescription run = Describe(MakePlan(SmallStudy()));
    change(&run);
    std::filesystem::remove(path_);
    NewTrials(path_, run).Finish(run);
    return ThrowsInputError([&] { ResultStore::OpenForReading(path_); }, {path_, "control characters"});
  };
  for (const std::string text : {"a\x1B[2Jb", "a\nb", "a\tb",
                                 "a\xC2\x9B"
                                 "b",
                                 "a\xE9"}) {
    EXPECT_TRUE(refuses([&](RunDescription* run) { run->study = text; }));
    EXPECT_TRUE(refuses([&](RunDescription* run) { run->factors[0] = text; }));
    EXPECT_TRUE(refuses([&](RunDescription* run) { run->conditions[1].levels[0] = text; }));
    EXPECT_TRUE(refuses([&](RunDescription* run) { run->estimators[1].label = text; }));
    EXPECT_TRUE(refuses([&](RunDescription* run) { run->estimators[1].effort = text; }));
    EXPECT_TRUE(refuses([&](RunDescription* run) { run->origin.program = text; }));
  }
  EXPECT_TRUE(refuses([](RunDescription* run) { run->description = "a\x1B[2Jb"; }));
  EXPECT_FALSE(refuses([](RunDescription* run) { run->description = "two\nlines"; }));
}

TEST_F(Description, TheFolderOfRealPairsIsNotNeeded) {
  const std::string pairs = folder_.Path("pairs");
  std::filesystem::create_directory(pairs);
  const StudyPlan simulated = MakePlan(SmallStudy());
  const TrialData data = simulated.conditions[0].source->Make({1, 0, 0, 0});
  WriteMatchFile({"",
                  "street",
                  data.problem.matches,
                  data.problem.camera1,
                  data.problem.camera2,
                  data.truth.cam2_from_cam1_true,
                  {},
                  {},
                  {},
                  {}},
                 pairs + "/one.csv");
  Study study = SmallStudy();
  study.factors.clear();
  study.data = {{"scene", "match_files"}, {"folder", pairs}};
  const StudyPlan plan = MakePlan(study);
  {
    ResultStore store = ResultStore::OpenForRun(path_, plan);
    RunStudy(plan, 1, &store);
  }
  const std::string before = SummaryAsCsv(Summarize(ResultStore::OpenForReading(path_), false));
  std::filesystem::remove_all(pairs);
  const ResultStore store = ResultStore::OpenForReading(path_);
  EXPECT_EQ(SummaryAsCsv(Summarize(store, false)), before);
  EXPECT_EQ(store.Description().factors, std::vector<std::string>{"pair_scene"});
  EXPECT_EQ(store.Description().conditions.at(0).levels, std::vector<std::string>{"street"});
  EXPECT_TRUE(ThrowsInputError([&] { store.Plan(); }, {path_, "folder"}));
}

}  // namespace
}  // namespace rcme
