#include "experiments/statistics/trial_table.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <sstream>

#include "experiments/run/run_study.h"
#include "experiments/statistics/summarize.h"
#include "tests/test_support/add_records.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using Row = std::map<std::string, std::string>;  // column: field

std::vector<std::string> Fields(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream rest(line + ",");
  for (std::string field; std::getline(rest, field, ',');) fields.push_back(field);
  return fields;
}

class TrialTable : public testing::Test {
 protected:
  std::vector<Row> Rows(bool with_times = false) {
    std::string text;
    WriteTrialTable(ResultStore::OpenForReading(path_), with_times,
                    [&](const std::string& part) { text += part; });
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    header_ = Fields(line);
    std::vector<Row> rows;
    while (std::getline(lines, line)) {
      const std::vector<std::string> fields = Fields(line);
      EXPECT_EQ(fields.size(), header_.size()) << line;
      Row row;
      for (size_t i = 0; i < header_.size(); ++i) EXPECT_TRUE(row.emplace(header_[i], fields.at(i)).second);
      rows.push_back(row);
    }
    return rows;
  }

  TempFolder folder_;
  std::string path_ = folder_.Path("run.sqlite");
  std::vector<std::string> header_;
  Study study_ = SmallStudy();
};

TEST_F(TrialTable, EveryOutcomeHasItsWord) {
  study_.estimators.resize(1);
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<TrialRecord> records;
  std::vector<std::string> words;
  const auto add = [&](MotionStatus status, double rotation_error_deg, const std::string& word) {
    TrialRecord record;
    record.trial = static_cast<std::uint32_t>(records.size());
    record.status = status;
    record.rotation_error_deg = rotation_error_deg;
    records.push_back(record);
    words.push_back(word);
  };
  add(MotionStatus::kOk, 1.0, "success");
  add(MotionStatus::kOk, 5.0, "failure");
  add(MotionStatus::kOk, unknown, "not_scored");
  for (const MotionStatus status : AllStatuses()) {
    if (status == MotionStatus::kOk) continue;
    const bool is_invalid =
        status == MotionStatus::kInvalidMotion || status == MotionStatus::kInvalidCovariance;
    const bool is_counted = status != MotionStatus::kNotSimulated && status != MotionStatus::kTruthInDoubt;
    add(status, unknown, is_invalid ? "failure" : is_counted ? "refusal" : "not_scored");
  }
  {
    ResultStore store = ResultStore::OpenForRun(path_, MakePlan(study_));
    AddRecords(store, records);
  }
  const std::vector<Row> rows = Rows();
  ASSERT_EQ(rows.size(), records.size());
  for (size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].at("outcome"), words[i]);
    EXPECT_EQ(rows[i].at("status"), StatusName(records[i].status));
  }
  EXPECT_EQ(rows[1].at("rotation_error_deg"), "5");
  EXPECT_EQ(rows[2].at("rotation_error_deg"), "") << "not known";
}

// The very numbers of the file, one row per trial and estimator, with the levels.
TEST_F(TrialTable, OneRowPerTrialAndEstimatorWithAllNumbers) {
  const StudyPlan plan = MakePlan(study_);
  {
    ResultStore store = ResultStore::OpenForRun(path_, plan);
    RunStudy(plan, 2, &store);
  }
  const std::vector<Row> rows = Rows();
  ASSERT_EQ(rows.size(), 2u * 6 * 2);
  EXPECT_EQ(std::vector<std::string>(header_.begin(), header_.begin() + 7),
            (std::vector<std::string>{"study", "condition", "outlier_ratio", "trial", "estimator", "outcome",
                                      "status"}));
  size_t r = 0;
  const ResultStore store = ResultStore::OpenForReading(path_);
  store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    for (const TrialRecord& record : records) {
      const Row& row = rows[r++];
      EXPECT_EQ(row.at("study"), "small");
      EXPECT_EQ(row.at("outlier_ratio"), record.condition == 0 ? "0" : "0.3");
      EXPECT_EQ(row.at("estimator"), record.estimator == 0 ? "standard" : "ours");
      EXPECT_EQ(row.at("trial"), fmt::format("{}", record.trial));
      EXPECT_EQ(row.at("num_support"), fmt::format("{}", record.num_support));
      EXPECT_EQ(row.at("nees"), std::isnan(record.nees) ? "" : fmt::format("{}", record.nees));
      EXPECT_EQ(row.at("crb_rotation_deg"), fmt::format("{}", problem.severity.crb_rotation_deg));
    }
  });
  EXPECT_EQ(r, rows.size());
  EXPECT_EQ(rows[0].count("seconds"), 0u) << "no two runs share it";
  EXPECT_EQ(Rows(/*with_times=*/true)[0].count("seconds"), 1u);
}

TEST_F(TrialTable, TheWordsCountAsTheSummaryDoes) {
  const StudyPlan plan = MakePlan(study_);
  {
    ResultStore store = ResultStore::OpenForRun(path_, plan);
    RunStudy(plan, 2, &store);
  }
  std::map<std::string, int> count;  // condition, estimator, word
  for (const Row& row : Rows()) {
    for (const char* word : {"outcome", "status"})
      ++count[row.at("condition") + row.at("estimator") + row.at(word)];
  }
  for (const SummaryRow& row : Summarize(ResultStore::OpenForReading(path_), false).rows) {
    if (row.quantity != "success" && row.quantity != "failure" && row.quantity != "no_candidate") continue;
    EXPECT_EQ(count[fmt::format("{}{}{}", row.condition, row.estimator, row.quantity)],
              std::llround(row.value * static_cast<double>(row.n)))
        << row.quantity.text();
  }
}

TEST_F(TrialTable, AFactorThatIsCalledAsAnotherColumn) {
  study_.factors = {{"num_matches", {"50", "70"}}};
  {
    ResultStore store = ResultStore::OpenForRun(path_, MakePlan(study_));
    TrialRecord one, other;
    other.estimator = 1;
    one.num_matches = other.num_matches = 48;
    AddRecords(store, {one, other});
  }
  const Row row = Rows().at(0);
  EXPECT_EQ(row.at("level_num_matches"), "50");
  EXPECT_EQ(row.at("num_matches"), "48");
}

}  // namespace
}  // namespace rcme
