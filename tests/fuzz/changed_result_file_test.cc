// Result files changed by hand, through SQL: every column, rows, tables.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/fuzz/damaged_result_file.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

class ChangedResultFile : public DamagedResultFile {
 protected:
  // The sound file after some SQL; false if SQLite refuses it.
  bool Change(const std::string& sql) { return Execute(Write(*bytes_), sql); }
};

TEST_F(ChangedResultFile, TheSoundOneIsRead) {
  Write(*bytes_);
  EXPECT_EQ(Read("sound"), FileOutcome::kSame);
  EXPECT_EQ(Resume("sound"), FileOutcome::kSame);
  EXPECT_EQ(SaveAndComplete("sound"), 2 * kTrials);
}

// Every value of every column of one trial replaced, by every type and by numbers out of range.
TEST_F(ChangedResultFile, EveryColumnOfEveryTable) {
  const std::vector<std::string> values = {"'text'", "x'00ff'", "NULL", "-1", "3", "1e300", "9e18", "0.5"};
  std::vector<std::pair<std::string, std::string>> columns = {
      // table and rows, column
      {"run WHERE key = 'study'", "value"},
      {"run WHERE key = 'identity'", "value"},
      {"run WHERE key = 'format'", "value"},
      {"run WHERE key = 'checksum'", "value"},
      {"run WHERE key = 'study'", "key"},
      {"run WHERE key = 'seed'", "value"},
      {"run WHERE key = 'max_rotation_error_deg'", "value"},
      {"factors WHERE factor = 0", "name"},
      {"factors WHERE factor = 0", "factor"},
      {"conditions WHERE condition = 1", "num_trials"},
      {"conditions WHERE condition = 1", "condition"},
      {"levels WHERE condition = 1", "level"},
      {"levels WHERE condition = 1", "factor"},
      {"levels WHERE condition = 1", "condition"},
      {"estimators WHERE estimator = 1", "label"},
      {"estimators WHERE estimator = 1", "name"},
      {"options WHERE estimator = 1 AND name = 'mu'", "value"},
      {"options WHERE estimator = 1 AND name = 'mu'", "estimator"},
      {"estimators WHERE estimator = 1", "estimator"},
      {"totals WHERE condition = 1", "condition"},
      {"totals WHERE condition = 1", "num_trials"},
      {"totals WHERE condition = 1", "checksum"},
      {"problems WHERE condition = 1 AND trial = 3", "checksum"}};
  TrialRecord record;
  VisitColumns(record, [&](const StoredColumn& column, const auto&) {
    columns.emplace_back("trials WHERE condition = 1 AND trial = 3 AND estimator = 1", column.name);
  });
  ProblemRecord problem;
  VisitColumns(problem, [&](const StoredColumn& column, const auto&) {
    columns.emplace_back("problems WHERE condition = 1 AND trial = 3", column.name);
  });
  int num_refused = 0, num_same = 0, num_impossible = 0;
  for (const auto& [rows, column] : columns) {
    const size_t space = rows.find(' ');
    for (const std::string& value : values) {
      const std::string sql =
          fmt::format("UPDATE {} SET {} = {}{}", rows.substr(0, space), column, value, rows.substr(space));
      if (!Change(sql)) {
        ++num_impossible;  // NOT NULL, or a key that is there already
        continue;
      }
      const FileOutcome outcome = Read(sql);  // the same: it was that value already
      EXPECT_EQ(Resume(sql), outcome) << sql;
      (outcome == FileOutcome::kRefused ? num_refused : num_same) += 1;
    }
  }
  fmt::print("{} changes of a column: {} refused, {} changed nothing, {} not taken by SQLite\n",
             columns.size() * values.size(), num_refused, num_same, num_impossible);
  EXPECT_GT(num_refused, 300);
  EXPECT_LT(num_same, 25);
}

// A column is read by its type and range before its checksum: the message says what is wrong with it.
TEST_F(ChangedResultFile, TheMessageNamesTheColumn) {
  const auto refuses = [&](const std::string& sql, const std::vector<std::string>& fragments) {
    EXPECT_TRUE(Change(sql)) << sql;
    return ThrowsInputError([&] { ResultStore::OpenForReading(path_).CheckTrials(); }, fragments);
  };
  EXPECT_TRUE(refuses("UPDATE trials SET num_inliers = 'many'",
                      {path_, "condition 0, trial 0", "num_inliers", "is text", "rcme check"}));
  EXPECT_TRUE(refuses("UPDATE trials SET nees = x'01'", {"nees of table trials is bytes"}));
  EXPECT_TRUE(refuses("UPDATE trials SET status = 'fine'", {"status", "'fine'", "not possible"}));
  EXPECT_TRUE(refuses("UPDATE trials SET num_support = 3000000000", {"num_support", "'3000000000'"}));
  EXPECT_TRUE(refuses("UPDATE trials SET num_matches = -1", {"num_matches", "'-1'"}));
  EXPECT_TRUE(refuses("UPDATE trials SET failed_by_kappa = 2", {"failed_by_kappa", "'2'"}));
  EXPECT_TRUE(refuses("UPDATE trials SET inlier_precision = 1.5", {"inlier_precision", "'1.5'"}));
  EXPECT_TRUE(refuses("UPDATE problems SET weight = -1", {"weight", "'-1.0'"}));
  EXPECT_TRUE(refuses("UPDATE problems SET num_inliers_true = 1 + num_inliers_true",
                      {"condition 0, trial 0", "checksum"}));
  EXPECT_TRUE(
      refuses("DELETE FROM problems WHERE trial = 5", {"condition 0, trial 6", "others are in its place"}));
}

// A fixed number of trials gives exact intervals, a stopping rule anytime-valid ones; damage elsewhere
// changes neither.
TEST_F(ChangedResultFile, TheKindOfIntervalSurvivesDamageElsewhere) {
  const auto saved_rule = [&](const std::string& sql) {
    EXPECT_TRUE(Change(sql)) << sql;
    return Salvage(path_).description().stopping_rule;
  };
  const std::vector<std::string> elsewhere = {
      "UPDATE run SET value = 'x' WHERE key = 'description'",
      "UPDATE run SET value = 'x' WHERE key = 'program'", "UPDATE levels SET level = 'x' WHERE condition = 1",
      "DELETE FROM options", "DELETE FROM run WHERE key = 'checksum'"};
  for (const std::string& sql : elsewhere) EXPECT_EQ(saved_rule(sql), "") << sql;
  for (const char* sql : {"UPDATE run SET value = 'a reason' WHERE key = 'stopping_rule'",
                          "DELETE FROM run WHERE key = 'stopping_rule_checksum'"})
    EXPECT_TRUE(saved_rule(sql).starts_with("not known")) << sql;
  const std::string fixed = *bytes_;
  Write(fixed);
  ResultStore::OpenForRun(path_, *plan_).NoteStoppingRule("narrow enough");
  *bytes_ = ReadBytes(path_);
  for (const std::string& sql : elsewhere) EXPECT_EQ(saved_rule(sql), "narrow enough") << sql;
  EXPECT_TRUE(saved_rule("DELETE FROM run WHERE key = 'stopping_rule'").starts_with("not known"));
  *bytes_ = fixed;
}

TEST_F(ChangedResultFile, RowsLostDoubledSwappedAndForeign) {
  const std::string trial = " WHERE condition = 1 AND trial = 3";
  const auto copy = [&](const std::string& table, const std::string& key, const std::string& other) {
    return "CREATE TEMP TABLE t AS SELECT * FROM " + table + trial + "; UPDATE t SET " + key + " = " + other +
           "; INSERT INTO " + table + " SELECT * FROM t; DROP TABLE t;";
  };
  for (const std::string& sql : std::vector<std::string>{
           "DELETE FROM trials" + trial,
           "DELETE FROM trials" + trial + " AND estimator = 1",
           "DELETE FROM problems" + trial,
           "DELETE FROM trials" + trial + "; DELETE FROM problems" + trial,
           "DELETE FROM trials WHERE trial = 11; DELETE FROM problems WHERE trial = 11",
           "DELETE FROM trials WHERE condition = 1; DELETE FROM problems WHERE condition = 1",
           "DELETE FROM trials; DELETE FROM problems",
           "DELETE FROM run",
           "DELETE FROM run WHERE key = 'checksum'",
           "DELETE FROM run WHERE key = 'instruction_set'",
           "UPDATE run SET value = 'a reason' WHERE key = 'stopping_rule'",
           "DELETE FROM conditions",
           "INSERT INTO conditions VALUES (2, 6)",
           "DELETE FROM factors",
           "DELETE FROM levels WHERE condition = 1",
           "INSERT INTO levels VALUES (2, 0, '0.5')",
           "DELETE FROM options WHERE estimator = 1 AND name = 'mu'",
           "DELETE FROM estimators WHERE estimator = 1",
           "INSERT INTO estimators VALUES (2, 'foreign', 'foreign', '')",
           "DELETE FROM totals",
           "DELETE FROM totals WHERE condition = 1",
           "INSERT INTO totals VALUES (2, 0, 0)",
           copy("trials", "estimator", "estimator + 2"),  // more records than estimators
           copy("trials", "estimator", "estimator + 4000000000"),
           copy("trials", "trial", "99"),
           copy("trials", "condition", "2"),
           copy("trials", "condition", "4294967295") + copy("problems", "condition", "4294967295"),
           copy("problems", "trial", "99"),
           copy("trials", "trial", "99") + copy("problems", "trial", "99"),
           "UPDATE trials SET estimator = 1 - estimator + 10; UPDATE trials SET estimator = estimator - 10",
           "UPDATE trials SET trial = trial + 100; UPDATE problems SET trial = trial + 100",
           "UPDATE problems SET trial = trial + 100",
           "UPDATE trials SET seconds = seconds + 1e-9" + trial}) {
    ASSERT_TRUE(Change(sql)) << sql;
    ExpectRefused(sql);
  }
}

// To read one trial not all are read: the one that is must be sound, and one that is not found is looked for.
TEST_F(ChangedResultFile, ASingleTrialIsNeverTakenForAnother) {
  const auto read = [&](std::uint32_t trial) {
    return ResultStore::OpenForReading(path_).ReadTrialRecords(1, trial).size();
  };
  const std::string trial = " WHERE condition = 1 AND trial = 3";
  ASSERT_TRUE(Change("UPDATE trials SET seconds = seconds + 1e-9" + trial));
  EXPECT_EQ(read(2), 2u) << "damage elsewhere was not read";
  EXPECT_TRUE(ThrowsInputError([&] { read(3); }, {path_, "checksum"}));
  EXPECT_TRUE(ThrowsInputError([&] { read(99); }, {path_, "checksum"})) << "not there, or lost";
  ASSERT_TRUE(Change("DELETE FROM trials" + trial + "; DELETE FROM problems" + trial));
  EXPECT_TRUE(ThrowsInputError([&] { read(3); }, {path_, "trials were counted"}));
  ASSERT_TRUE(Change("UPDATE options SET value = '1' WHERE name = 'mu'"));
  EXPECT_TRUE(ThrowsInputError([&] { read(2); }, {path_, "checksum"}))
      << "what describes the run is always read";
  Write(*bytes_);
  EXPECT_EQ(read(3), 2u);
  EXPECT_EQ(read(99), 0u);
}

// The last trial is damaged: the file opens, and who uses its trials is refused before anything is written.
TEST_F(ChangedResultFile, DamageIsMetWhereTrialsAreReadBeforeAnythingIsWritten) {
  const std::string sql = fmt::format(
      "UPDATE trials SET seconds = seconds + 1e-9 WHERE condition = 1 AND trial = {}", kTrials - 1);
  ASSERT_TRUE(Change(sql));
  const auto refuses = [&](auto use) {
    return ThrowsInputError([&] { use(ResultStore::OpenForReading(path_)); }, {path_, "checksum"});
  };
  std::string written;
  EXPECT_TRUE(refuses([&](const ResultStore& store) {
    WriteTrialTable(store, /*with_times=*/true, [&](const std::string& rows) { written += rows; });
  }));
  EXPECT_EQ(written, "");
  EXPECT_TRUE(refuses([](const ResultStore& store) { Summarize(store, /*with_times=*/false); }));
  EXPECT_TRUE(refuses([](const ResultStore& store) { Compare(store, ""); }));
  EXPECT_TRUE(refuses([](const ResultStore& store) { store.CheckTrials(); }));
  EXPECT_TRUE(refuses([](ResultStore&& store) { store.MissingTrials(0, kTrials); }));
  const auto ignore = [](const ProblemRecord&, const std::vector<TrialRecord>&) {};
  EXPECT_TRUE(refuses([&](const ResultStore& store) { store.ForEachTrial(ignore, 1); }));
  ResultStore::OpenForReading(path_).ForEachTrial(ignore, 0);  // of a sound condition
  EXPECT_EQ(ResultStore::OpenForReading(path_).Plan().conditions.size(), 2u);
}

// Under a stopping rule the totals say how many trials there are: a plan is made of sound ones alone.
TEST_F(ChangedResultFile, APlanUnderAStoppingRuleChecksTheTrials) {
  Write(*bytes_);
  ResultStore::OpenForRun(path_, *plan_).NoteStoppingRule("narrow enough");
  EXPECT_EQ(ResultStore::OpenForReading(path_).Plan().conditions[1].num_trials, kTrials);
  ASSERT_TRUE(Execute(path_, "UPDATE totals SET num_trials = 3 WHERE condition = 1"));
  EXPECT_TRUE(
      ThrowsInputError([&] { ResultStore::OpenForReading(path_).Plan(); }, {path_, "3 trials were counted"}));
}

TEST_F(ChangedResultFile, AnotherSchema) {
  const auto edited = [](const std::string& from, const std::string& to) {
    return "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = replace(sql, '" + from + "', '" + to +
           "')";
  };
  for (const std::string& sql : std::vector<std::string>{
           "CREATE VIEW extra AS SELECT * FROM trials", "CREATE TABLE extra (x)",
           "CREATE INDEX extra ON trials (nees)",
           "CREATE TRIGGER extra AFTER INSERT ON trials BEGIN DELETE FROM trials; END",
           "ALTER TABLE trials RENAME COLUMN nees TO nes", "ALTER TABLE trials ADD COLUMN extra REAL",
           "ALTER TABLE trials DROP COLUMN nees", "ALTER TABLE trials RENAME TO trails", "DROP TABLE trials",
           "DROP TABLE problems; CREATE VIEW problems AS SELECT * FROM trials",
           "ALTER TABLE trials RENAME TO t; CREATE VIEW trials AS SELECT * FROM t", "DROP TABLE totals",
           edited("nees REAL", "nees TEXT"), edited("num_support INTEGER NOT NULL", "num_support INTEGER"),
           edited("rotation_error_deg REAL, direction_error_deg REAL",
                  "direction_error_deg REAL, rotation_error_deg REAL")}) {
    ASSERT_TRUE(Change(sql)) << sql;
    ExpectRefused(sql);
  }
}

}  // namespace
}  // namespace rcme
