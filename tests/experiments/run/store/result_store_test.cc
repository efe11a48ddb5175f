#include "experiments/run/store/result_store.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include "experiments/run/store/schema.h"
#include "stats/constants.h"
#include "tests/test_support/add_records.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using Trials = std::vector<std::uint32_t>;

// Both estimators' records of one trial, no two numbers alike, all within what their columns may hold.
std::vector<TrialRecord> RecordsOfTrial(std::uint32_t condition, std::uint32_t trial) {
  std::vector<TrialRecord> records;
  for (std::uint32_t estimator = 0; estimator < 2; ++estimator) {
    TrialRecord record;
    int next = static_cast<int>(100'000 * condition + 1000 * trial + 100 * estimator);
    VisitColumns(record, [&](const StoredColumn&, auto& field) {
      using Field = std::decay_t<decltype(field)>;
      if constexpr (std::is_same_v<Field, double>) {
        field = (++next + 1.0 / 3.0) / 1e6;
      } else if constexpr (std::is_same_v<Field, int>) {
        field = ++next;
      }
    });
    record.status = MotionStatus::kOk;
    record.condition = condition;
    record.trial = trial;
    record.estimator = estimator;
    record.failed_by_kappa = estimator == 1;
    records.push_back(record);
  }
  return records;
}

// Both estimators' records of a trial, alike.
std::vector<TrialRecord> Twice(const TrialRecord& record) {
  std::vector<TrialRecord> records(2, record);
  records[1].estimator = 1;
  return records;
}

// The first column of the first row that `sql` gives.
std::string Query(const std::string& path, const std::string& sql) {
  sqlite3* database = nullptr;
  sqlite3_open(path.c_str(), &database);
  std::string answer = "(no row)";
  const auto keep_first = [](void* out, int, char** values, char**) {
    *static_cast<std::string*>(out) = values[0] ? values[0] : "NULL";
    return 0;
  };
  char* error = nullptr;
  if (sqlite3_exec(database, sql.c_str(), keep_first, &answer, &error) != SQLITE_OK) answer = error;
  sqlite3_free(error);
  sqlite3_close(database);
  return answer;
}

// Trials of the condition that are not in the file, one by one.
Trials Missing(ResultStore& store, std::uint32_t condition, std::uint32_t num_trials) {
  Trials missing;
  for (const TrialRange& range : store.MissingTrials(condition, num_trials)) {
    EXPECT_LT(range.first, range.end);
    for (std::uint32_t trial = range.first; trial < range.end; ++trial) missing.push_back(trial);
  }
  return missing;
}

class ResultStoreTest : public testing::Test {
 protected:
  std::string Text(const ResultStore& store) {
    std::string text;
    store.ForEachRecord([&](const TrialRecord& record) { text += RecordText(record) + "\n"; });
    return text;
  }
  testing::AssertionResult RefusesToRun(const std::string& path, std::vector<std::string> fragments) {
    fragments.push_back(path);
    return ThrowsInputError([&] { ResultStore::OpenForRun(path, plan_); }, fragments);
  }

  TempFolder folder_;
  std::string path_ = folder_.Path("run.sqlite");
  StudyPlan plan_ = MakePlan(SmallStudy());
};

TEST_F(ResultStoreTest, KeepsEveryFieldOfEveryRecord) {
  std::string expected;
  for (const auto& [condition, trial] : {std::pair{0u, 0u}, {0u, 4u}, {1u, 2u}}) {
    for (const TrialRecord& record : RecordsOfTrial(condition, trial)) expected += RecordText(record) + "\n";
  }
  {
    ResultStore store = ResultStore::OpenForRun(path_, plan_);
    AddRecords(store, RecordsOfTrial(1, 2));  // in any order
    AddRecords(store, RecordsOfTrial(0, 4));
    AddRecords(store, RecordsOfTrial(0, 0));
    EXPECT_EQ(Text(store), expected);  // seen before it is written
  }
  const ResultStore store = ResultStore::OpenForReading(path_);
  EXPECT_EQ(Text(store), expected);
  EXPECT_EQ(store.Plan().study_yaml, plan_.study_yaml);
  ASSERT_EQ(store.ReadTrialRecords(0, 4).size(), 2u);
  EXPECT_EQ(RecordText(store.ReadTrialRecords(0, 4)[1]), RecordText(RecordsOfTrial(0, 4)[1]));
  EXPECT_EQ(store.ReadTrialRecords(0, 4)[1].seconds, RecordsOfTrial(0, 4)[1].seconds);
  EXPECT_TRUE(store.ReadTrialRecords(0, 5).empty());
}

TEST_F(ResultStoreTest, TablesAreReadableWithoutUs) {
  {
    ResultStore store = ResultStore::OpenForRun(path_, plan_);
    AddRecords(store, RecordsOfTrial(1, 2));
  }
  EXPECT_EQ(Query(path_,
                  "SELECT level FROM levels NATURAL JOIN factors WHERE condition = 1 AND name = "
                  "'outlier_ratio'"),
            "0.3");
  EXPECT_EQ(Query(path_, "SELECT label FROM estimators WHERE estimator = 1"), "ours");
  EXPECT_EQ(Query(path_, "SELECT count(*) FROM trials WHERE status = 'ok'"), "2");
  EXPECT_EQ(Query(path_, "PRAGMA integrity_check"), "ok");
}

TEST_F(ResultStoreTest, TheTableRunHasTheKeysThatAreWrittenDown) {
  { ResultStore::OpenForRun(path_, plan_); }
  EXPECT_EQ(Query(path_, "SELECT count(*) FROM run"), fmt::format("{}", RunKeys().size()));
  for (const RunKey& key : RunKeys()) {
    EXPECT_EQ(Query(path_, fmt::format("SELECT count(*) FROM run WHERE key = '{}'", key.name)), "1")
        << key.name;
  }
}

TEST_F(ResultStoreTest, UnknownNumbersAreNull) {
  TrialRecord record;
  record.status = MotionStatus::kNoCandidate;
  record.rotation_error_deg = kNaN;
  record.nees = std::numeric_limits<double>::infinity();
  {
    ResultStore store = ResultStore::OpenForRun(path_, plan_);
    AddRecords(store, Twice(record));
  }
  EXPECT_EQ(Query(path_, "SELECT rotation_error_deg FROM trials"), "NULL");
  EXPECT_EQ(Query(path_, "SELECT count(*) FROM trials WHERE direction_error_deg IS NULL"), "0");
  const ResultStore store = ResultStore::OpenForReading(path_);
  const TrialRecord again = store.ReadTrialRecords(0, 0).at(0);
  EXPECT_TRUE(std::isnan(again.rotation_error_deg));
  EXPECT_EQ(again.direction_error_deg, 0.0);
  EXPECT_EQ(again.nees, std::numeric_limits<double>::infinity());
}

TEST_F(ResultStoreTest, EveryStatusComesBack) {
  ResultStore store = ResultStore::OpenForRun(path_, plan_);
  std::uint32_t trial = 0;
  for (const MotionStatus status : AllStatuses()) {
    TrialRecord record;
    record.trial = trial++;
    record.status = status;
    AddRecords(store, Twice(record));
  }
  trial = 0;
  for (const MotionStatus status : AllStatuses())
    EXPECT_EQ(store.ReadTrialRecords(0, trial++).at(0).status, status);
}

TEST_F(ResultStoreTest, MissingTrials) {
  ResultStore store = ResultStore::OpenForRun(path_, plan_);
  EXPECT_EQ(Missing(store, 0, 4), (Trials{0, 1, 2, 3}));
  EXPECT_EQ(Missing(store, 0, 0), Trials{});
  for (const std::uint32_t trial : {0u, 2u, 5u}) AddRecords(store, RecordsOfTrial(0, trial));
  EXPECT_EQ(Missing(store, 0, 7), (Trials{1, 3, 4, 6}));
  EXPECT_EQ(store.MissingTrials(0, 7).size(), 3u) << "neighbours are one range";
  EXPECT_EQ(Missing(store, 0, 6), (Trials{1, 3, 4}));
  EXPECT_EQ(Missing(store, 0, 5), (Trials{1, 3, 4}));
  EXPECT_EQ(Missing(store, 0, 4), (Trials{1, 3}));
  EXPECT_EQ(Missing(store, 0, 1), Trials{});
  EXPECT_EQ(Missing(store, 1, 2), (Trials{0, 1}));
}

TEST_F(ResultStoreTest, AddsWholeTrialsOnce) {
  ResultStore store = ResultStore::OpenForRun(path_, plan_);
  AddRecords(store, RecordsOfTrial(0, 0));
  EXPECT_TRUE(ThrowsInputError([&] { AddRecords(store, RecordsOfTrial(0, 0)); }, {path_}));
}

// What is no whole trial of the study is not taken: a file of it would be refused ever after.
TEST_F(ResultStoreTest, AddsNothingButWholeTrials) {
  ResultStore store = ResultStore::OpenForRun(path_, plan_);
  std::vector<TrialRecord> one(1), three(3), swapped = RecordsOfTrial(0, 0);
  std::swap(swapped[0], swapped[1]);
  for (const auto& records : {one, three, swapped, RecordsOfTrial(2, 0)}) {
    EXPECT_THROW(AddRecords(store, records), std::logic_error);
  }
  EXPECT_THROW(store.Add({ProblemRecord()}, RecordsOfTrial(0, 1)), std::logic_error);
  EXPECT_EQ(Missing(store, 0, 2), (Trials{0, 1}));
}

TEST_F(ResultStoreTest, ASecondOriginIsNotedAndWarnedOf) {
  ResultStore store = ResultStore::OpenForRun(path_, plan_);
  EXPECT_EQ(store.NoteOrigin({"rcme 1", "AVX2"}), "") << "no trial is of another origin yet";
  AddRecords(store, RecordsOfTrial(0, 0));
  EXPECT_EQ(store.NoteOrigin({"rcme 1", "AVX2"}), "");
  const std::string warning = store.NoteOrigin({"rcme 1", "AVX-512"});
  for (const std::string& part : {path_, std::string("AVX2"), std::string("AVX-512")}) {
    EXPECT_NE(warning.find(part), std::string::npos) << warning;
  }
  EXPECT_EQ(store.Description().origin.program, "rcme 1");
  EXPECT_EQ(store.Description().origin.instruction_set, "AVX2, AVX-512");
  EXPECT_NE(store.NoteOrigin({"rcme 1", "AVX2"}), "") << "a part of the trials is of another";
}

TEST_F(ResultStoreTest, ACallThatFailsLeavesNothing) {
  std::vector<TrialRecord> records = RecordsOfTrial(0, 1), again = RecordsOfTrial(0, 0);
  records.insert(records.end(), again.begin(), again.end());
  {
    ResultStore store = ResultStore::OpenForRun(path_, plan_);
    AddRecords(store, again);
    store.Commit();
    EXPECT_TRUE(
        ThrowsInputError([&] { AddRecords(store, records); }, {path_}));  // after its first trial is in
    AddRecords(store, RecordsOfTrial(0, 2));
  }
  ResultStore store = ResultStore::OpenForRun(path_, plan_);
  EXPECT_EQ(Missing(store, 0, 4), (Trials{1, 3})) << "a part of a call was kept, or more than the call lost";
}

TEST_F(ResultStoreTest, ReopensForMoreTrialsAndAnotherDescription) {
  {
    ResultStore store = ResultStore::OpenForRun(path_, plan_);
    AddRecords(store, RecordsOfTrial(0, 0));
  }
  Study study = SmallStudy();
  study.trials = 50;
  study.description = "now with a description";
  const StudyPlan longer = MakePlan(study);
  {
    ResultStore store = ResultStore::OpenForRun(path_, longer);
    EXPECT_EQ(Missing(store, 0, 2), Trials{1});
  }
  EXPECT_EQ(ResultStore::OpenForReading(path_).Plan().study_yaml, longer.study_yaml);
}

TEST_F(ResultStoreTest, FewerTrialsTakeNoneOfTheEarlierAway) {
  {
    ResultStore store = ResultStore::OpenForRun(path_, plan_);
    AddRecords(store, RecordsOfTrial(0, 0));
  }
  Study study = SmallStudy();
  study.trials = 2;
  { ResultStore::OpenForRun(path_, MakePlan(study)); }
  const StudyPlan kept = ResultStore::OpenForReading(path_).Plan();
  EXPECT_EQ(kept.study_yaml, plan_.study_yaml);
  EXPECT_EQ(kept.NumTrials(), 12);
}

TEST_F(ResultStoreTest, UnderAStoppingRuleThePlanIsWhatWasDone) {
  ResultStore store = ResultStore::OpenForRun(path_, plan_);
  AddRecords(store, RecordsOfTrial(1, 0));
  EXPECT_EQ(store.Plan().NumTrials(), 12);
  store.NoteStoppingRule("a reason");
  for (const std::uint32_t trial : {1u, 2u, 3u, 4u, 5u, 6u, 7u}) AddRecords(store, RecordsOfTrial(1, trial));
  EXPECT_EQ(store.Plan().conditions[0].num_trials, 0);
  EXPECT_EQ(store.Plan().conditions[1].num_trials, 8);
}

TEST_F(ResultStoreTest, UntilOptionsAreKnownAsLongAsTheyAloneGiveTheTrials) {
  ResultStore store = ResultStore::OpenForRun(path_, plan_);
  EXPECT_EQ(store.Description().until_options, "");
  AddRecords(store, RecordsOfTrial(0, 0));
  store.NoteUntilOptions("--until ci=0.1", 1);
  EXPECT_EQ(store.Description().until_options, "--until ci=0.1");
  AddRecords(store, RecordsOfTrial(0, 1));
  EXPECT_EQ(store.Description().until_options, "");
}

TEST_F(ResultStoreTest, RefusesAnotherStudyAndSaysWhatDiffers) {
  {
    ResultStore store = ResultStore::OpenForRun(path_, plan_);
    AddRecords(store, RecordsOfTrial(0, 0));
  }
  const std::string bytes = ReadBytes(path_);
  const auto refuses = [&](const std::string& key, const std::string& value, const std::string& difference) {
    Study study = SmallStudy();
    Override(&study, key, value);
    return ThrowsInputError([&] { ResultStore::OpenForRun(path_, MakePlan(study)); },
                            {path_, "another study", difference, "--out"});
  };
  EXPECT_TRUE(refuses("sigma_px", "0.7", "sigma_px: 0.7' here"));
  EXPECT_TRUE(refuses("sigma_px", "0.7", "sigma_px: 0.5' there"));
  EXPECT_TRUE(refuses("ours.mu", "-1", "mu: -1' here"));
  EXPECT_TRUE(refuses("max_rotation_error_deg", "1", "max_rotation_error_deg: 1' here"));
  EXPECT_TRUE(refuses("outlier_ratio", "0.3", "outlier_ratio"));
  Study study = SmallStudy();
  study.seed = 4;
  EXPECT_TRUE(ThrowsInputError([&] { ResultStore::OpenForRun(path_, MakePlan(study)); },
                               {"'seed: 3' there, 'seed: 4' here"}));
  study = SmallStudy();
  study.estimators.pop_back();
  EXPECT_TRUE(ThrowsInputError([&] { ResultStore::OpenForRun(path_, MakePlan(study)); }, {"another study"}));
  EXPECT_EQ(ReadBytes(path_), bytes) << "a refusal changed the file";
}

TEST_F(ResultStoreTest, RefusesFilesOfOthers) {
  const std::string text = "this is a letter, not a database; it must not be lost\n" + std::string(5000, '.');
  const std::string letter = folder_.Write("letter.txt", text);
  EXPECT_TRUE(RefusesToRun(letter, {"is not an rcme result file"}));
  EXPECT_TRUE(
      ThrowsInputError([&] { ResultStore::OpenForReading(letter); }, {letter, "is not an rcme result file"}));
  EXPECT_EQ(ReadBytes(letter), text);

  const std::string other = folder_.Path("other.sqlite");
  Query(other, "CREATE TABLE letters (text)");
  EXPECT_TRUE(RefusesToRun(other, {"is not an rcme result file"}));
  EXPECT_TRUE(
      ThrowsInputError([&] { ResultStore::OpenForReading(other); }, {other, "is not an rcme result file"}));
  EXPECT_EQ(Query(other, "SELECT count(*) FROM sqlite_master"), "1");

  const std::string later = folder_.Path("later.sqlite");
  { ResultStore::OpenForRun(later, plan_); }
  Query(later, "UPDATE run SET value = 'rcme results 99' WHERE key = 'format'");
  EXPECT_TRUE(RefusesToRun(later, {"another version", "'rcme results 99'", "'rcme results 10'"}));
  EXPECT_TRUE(ThrowsInputError([&] { ResultStore::OpenForReading(later); }, {later, "another version"}));
}

TEST_F(ResultStoreTest, PathsThatCannotBeWritten) {
  EXPECT_TRUE(RefusesToRun(folder_.path(), {"is a folder"}));
  EXPECT_TRUE(RefusesToRun(folder_.Path("none/run.sqlite"), {"does not exist"}));
  EXPECT_TRUE(RefusesToRun("", {"--out", "''"}));
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_TRUE(RefusesToRun("/dev/full", {"cannot be written"}));
  }
}

TEST_F(ResultStoreTest, NamesThatSqliteReadsOtherwiseAreFiles) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path());
  for (const std::string name : {":memory:", "file:run", "file:run?mode=memory", "r\xC3\xA4n 1.sqlite"}) {
    {
      ResultStore store = ResultStore::OpenForRun(name, plan_);
      AddRecords(store, RecordsOfTrial(0, 0));
    }
    EXPECT_TRUE(std::filesystem::is_regular_file(folder_.Path(name))) << name;
    EXPECT_EQ(ResultStore::OpenForReading(name).ReadTrialRecords(0, 0).size(), 2u) << name;
  }
  std::filesystem::current_path(before);
}

TEST_F(ResultStoreTest, ReadOnlyFolder) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  std::filesystem::permissions(folder_.path(),
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_TRUE(RefusesToRun(path_, {"cannot be opened for writing"}));
  std::filesystem::permissions(folder_.path(), std::filesystem::perms::owner_all);
}

TEST_F(ResultStoreTest, ASecondRunIsRefusedWhileTheFirstGoesOn) {
  {
    ResultStore first = ResultStore::OpenForRun(path_, plan_);
    AddRecords(first, RecordsOfTrial(0, 0));
    EXPECT_TRUE(RefusesToRun(path_, {"in use by another run"}));
    EXPECT_TRUE(
        ThrowsInputError([&] { ResultStore::OpenForReading(path_); }, {path_, "in use by another run"}));
    AddRecords(first, RecordsOfTrial(0, 1));
  }
  ResultStore second = ResultStore::OpenForRun(path_, plan_);
  EXPECT_EQ(Missing(second, 0, 3), Trials{2});
}

TEST_F(ResultStoreTest, NothingToRead) {
  EXPECT_TRUE(ThrowsInputError([&] { ResultStore::OpenForReading(path_); }, {path_, "no such result file"}));
  EXPECT_TRUE(ThrowsInputError([&] { ResultStore::OpenForReading(folder_.path()); },
                               {"is a folder, not a result file"}));
  EXPECT_TRUE(ThrowsInputError([&] { ResultStore::OpenForReading("/dev/zero"); }, {"is a device"}));
  EXPECT_EQ(folder_.NumEntries(), 0) << "looking for a file made one";
}

TEST_F(ResultStoreTest, ADamagedFileIsNamed) {
  {
    ResultStore store = ResultStore::OpenForRun(path_, plan_);
    for (std::uint32_t trial = 0; trial < 200; ++trial) AddRecords(store, RecordsOfTrial(0, trial));
  }
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) / 2);
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        const ResultStore store = ResultStore::OpenForReading(path_);
        Text(store);
      },
      {path_, "damaged"}));
}

}  // namespace
}  // namespace rcme
