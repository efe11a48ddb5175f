// The paper's table from records that are known, and its printed figures against the shares that it prints.
#include "experiments/real/paper_table/paper_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "experiments/core/table/render_table.h"
#include "experiments/real/paper_table/paper_table_output.h"
#include "experiments/real/paper_table/printed_table.h"
#include "experiments/study/study_file.h"
#include "tests/test_support/add_records.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// Shares as printed, per cent: RCME and pRCME Detect-fail and Failure, Standard Failure.
struct PrintedShares {
  const char* name;
  double rcme_detect_fail, rcme_failure, prcme_detect_fail, prcme_failure, standard_failure;
};
constexpr PrintedShares kShares[] = {{"KITTI/01", 0, 0, 0, 0, 1.79},
                                     {"KITTI/02", 0, 0, 0, 0.05, 0.05},
                                     {"KITTI/05", 0, 0, 0, 0, 0.27},
                                     {"KITTI/08", 0, 0, 0, 0, 0.18},
                                     {"KITTI/09", 0, 0, 0, 0.15, 0},
                                     {"KITTI/10", 0, 0, 0, 0, 0.24},
                                     {"EuRoC/MH_01", 0.19, 0, 0, 0.19, 0.19},
                                     {"EuRoC/MH_02", 0, 0, 0, 0, 0.89},
                                     {"EuRoC/MH_04", 0.28, 0, 0.28, 0, 0.84},
                                     {"EuRoC/MH_05", 0.25, 0, 0, 0, 0.25},
                                     {"EuRoC/V1_01", 0, 0, 0, 0, 1.77},
                                     {"EuRoC/V1_02", 0.26, 0, 0.26, 0, 1.83},
                                     {"EuRoC/V1_03", 0.93, 0, 0.93, 0, 8.33},
                                     {"EuRoC/V2_01", 0.26, 0, 0.26, 0.26, 2.81},
                                     {"EuRoC/V2_02", 0, 0.17, 0, 0.17, 3.05},
                                     {"EuRoC/V2_03", 0, 0, 0, 0, 3.26},
                                     {"HRBB4th", 0, 0, 0, 0, 0.33}};

double FindPrintedShare(const PrintedRate& rate) {
  for (const PrintedShares& shares : kShares) {
    if (rate.row != shares.name) continue;
    const bool is_failure = rate.quantity == "failure";
    if (rate.method == "RCME") return is_failure ? shares.rcme_failure : shares.rcme_detect_fail;
    if (rate.method == "pRCME") return is_failure ? shares.prcme_failure : shares.prcme_detect_fail;
    return shares.standard_failure;
  }
  return 0.0;
}

TEST(PrintedTable, ItsCountsGiveThePrintedShares) {
  for (const PrintedRate& rate : PrintedRates()) {
    if (rate.row == "indoor" || rate.row == "outdoor") continue;
    EXPECT_DOUBLE_EQ(std::round(1e4 * rate.count / rate.n) / 100.0, FindPrintedShare(rate))
        << rate.row << ' ' << rate.method << ' ' << rate.quantity;
  }
}

TEST(PrintedTable, IndoorsAndOutdoors) {
  const auto failures_of = [](const std::string& row, const std::string& method) {
    for (const PrintedRate& rate : PrintedRates()) {
      if (rate.row == row && rate.method == method && rate.quantity == "failure") return rate;
    }
    return PrintedRate{};
  };
  EXPECT_EQ(failures_of("indoor", "RCME").n, 4738);
  EXPECT_EQ(failures_of("indoor", "RCME").count, 1);
  EXPECT_EQ(failures_of("indoor", "pRCME").count, 3);
  EXPECT_EQ(failures_of("indoor", "Standard").count, 68);
  EXPECT_EQ(failures_of("outdoor", "RCME").n, 10078);
  EXPECT_EQ(failures_of("outdoor", "RCME").count, 0);
  EXPECT_EQ(failures_of("outdoor", "pRCME").count, 2);
  EXPECT_EQ(failures_of("outdoor", "Standard").count, 10);
  EXPECT_NEAR(failures_of("outdoor", "RCME").interval.upper, 1.0 - std::pow(0.025, 1.0 / 10078), 1e-9);
  const std::vector<PrintedComparison> comparisons = PrintedComparisons();
  ASSERT_EQ(comparisons.size(), 4u);
  EXPECT_DOUBLE_EQ(comparisons[0].least_p, 0.5);       // 2 of 2 coins alike
  EXPECT_DOUBLE_EQ(comparisons[0].greatest_p, 0.625);  // at most 1 of 4
  EXPECT_LT(comparisons[1].greatest_p, 1e-15);         // RCME and Standard indoors
}

// Two scenes of three pairs around three images, and one whose truth nobody knows; two estimators, the second
// without a flag.
class PaperTableOfARun : public testing::Test {
 protected:
  PaperTableOfARun() {
    const char* images[3][2] = {{"1", "2"}, {"2", "3"}, {"1", "3"}};
    for (const std::string scene : {"kitti_a", "room"}) {
      for (int k = 0; k < 3; ++k) {
        std::string text = "# scene: ";
        text += scene + "\n# image1: " + images[k][0] + "\n# image2: " + images[k][1] + "\n";
        if (scene != "room") text += TruePoseHeader();
        pairs_.Write(scene + std::to_string(k) + ".csv", text + MatchHeader() + MatchRows(10));
      }
    }
  }

  ResultStore Run(const std::string& name) {
    const Study study = ParseStudy("name: t\ntrials: 1\ndata: {scene: match_files, folder: " + pairs_.path() +
                                       "}\nestimators: [{name: standard}, {name: rcme_calibrated}]\n",
                                   "t.yaml");
    ResultStore store = ResultStore::OpenForRun(pairs_.Path(name), MakePlan(study));
    std::vector<TrialRecord> records;
    for (std::uint32_t condition = 0; condition < 2; ++condition) {
      for (std::uint32_t trial = 0; trial < 3; ++trial) {
        for (std::uint32_t estimator = 0; estimator < 2; ++estimator)
          records.push_back(MakeRecord(condition, trial, estimator));
        if (condition == 0 && in_doubt_ == static_cast<int>(trial)) {
          for (TrialRecord& record : std::span(records).last(2)) {
            record.status = MotionStatus::kTruthInDoubt;
            record.rotation_error_deg = record.direction_error_deg = std::nan("");
          }
        }
      }
    }
    AddRecords(store, records);
    return store;
  }

  // Of the first scene: pair 0 right, but flagged by the first estimator; 1 wrong, flagged; 2 refused.
  static TrialRecord MakeRecord(std::uint32_t condition, std::uint32_t trial, std::uint32_t estimator) {
    TrialRecord record;
    record.condition = condition;
    record.trial = trial;
    record.estimator = estimator;
    record.status = trial == 2 ? (estimator == 0 ? MotionStatus::kNoCandidate : MotionStatus::kTooUncertain)
                               : MotionStatus::kOk;
    const double nan = std::nan("");
    record.rotation_error_deg = condition == 1 || trial == 2 ? nan : trial == 1 ? 50.0 : 0.1;
    record.direction_error_deg = condition == 1 || trial == 2 ? nan : 0.1;
    record.nees = record.inlier_precision = record.inlier_recall = nan;
    record.num_matches = 10;
    if (estimator == 0 && trial != 2) {
      record.num_consistent_before = 8;
      record.num_consistent_after = 2;
      record.failed_by_kappa = condition == 0;
    }
    return record;
  }

  TempFolder pairs_;
  int in_doubt_ = -1;  // the pair of the first scene whose truth is; negative: none
};

TEST_F(PaperTableOfARun, CountsWhatHappened) {
  const ResultStore run = Run("run.sqlite");
  const PaperTable table = MakePaperTable(run, UsualSceneGroups(), TableClusters::kImages);
  ASSERT_EQ(table.rows.size(), 4u);  // kitti_a, room, outdoor, all
  EXPECT_EQ(table.rows[0].name, "kitti_a");
  EXPECT_EQ(table.rows[2].name, "outdoor");
  EXPECT_TRUE(table.rows[2].is_group);
  const TableCell& standard = table.rows[0].cells[0];
  EXPECT_EQ(standard.detect_fail.num_events, 1);
  EXPECT_EQ(standard.detect_fail.n, 3);
  EXPECT_EQ(standard.detect_fail.num_apart, 1);
  EXPECT_EQ(standard.other_refusal.num_events, 0);
  EXPECT_EQ(standard.kappa_failure.num_events, 2);
  EXPECT_EQ(standard.true_failure.num_events, 1);
  EXPECT_EQ(standard.true_failure.n, 3);
  EXPECT_EQ(standard.flag_of_failed.num_events, 1);
  EXPECT_EQ(standard.flag_of_failed.n, 1);
  EXPECT_EQ(standard.flag_of_right.num_events, 1);
  EXPECT_EQ(standard.flag_of_right.n, 1);
  const TableCell& calibrated = table.rows[0].cells[1];
  EXPECT_EQ(calibrated.other_refusal.num_events, 1);
  EXPECT_EQ(calibrated.kappa_failure.n, 0);
  EXPECT_EQ(calibrated.flag_of_failed.n, 0);
  EXPECT_EQ(calibrated.true_failure.num_events, 1);
  EXPECT_EQ(table.rows[1].cells[0].true_failure.n, 0);  // nobody knows
  EXPECT_EQ(table.rows[1].cells[0].kappa_failure.num_events, 0);
  EXPECT_EQ(table.rows[3].cells[0].detect_fail.n, 6);
  EXPECT_EQ(table.rows[3].cells[0].detect_fail.num_apart, 2);
  EXPECT_EQ(MakePaperTable(run, {}, TableClusters::kSequences).rows[2].cells[0].detect_fail.num_members, 2);
}

// Of the three pairs of kitti_a one is right, one 50 degrees off, one refused.
TEST_F(PaperTableOfARun, OutcomesStandSideBySideAtEachBound) {
  const ResultStore run = Run("run.sqlite");
  const PaperTable table = MakePaperTable(run, {}, TableClusters::kImages, {0.05, 5.0});
  for (const TableRow& row : table.rows) {
    for (const TableCell& cell : row.cells) {
      for (const BoundOutcomes& o : cell.outcomes) {
        EXPECT_EQ(o.refusal.num_events + o.failure.num_events + o.success.num_events, o.success.n);
        EXPECT_EQ(o.failure.n, o.success.n);
      }
    }
  }
  const std::vector<BoundOutcomes>& outcomes = table.rows[0].cells[0].outcomes;
  ASSERT_EQ(outcomes.size(), 2u);
  EXPECT_EQ(outcomes[0].failure.num_events, 2);
  EXPECT_EQ(outcomes[1].failure.num_events, 1);
  EXPECT_EQ(outcomes[1].success.num_events, 1);
  EXPECT_EQ(outcomes[1].refusal.num_events, 1);
  EXPECT_NEAR(outcomes[1].area.value, (1.0 - 0.1 / 5.0) / 3.0, 1e-12);
  const CommandResult result = MakePaperResult(table);
  const std::string &text = result.text, csv = RenderCsv(result.rows);
  EXPECT_NE(text.find("Outcomes at 5 deg"), std::string::npos) << text;
  EXPECT_NE(csv.find("\nrun,kitti_a,standard,failure_5_deg,rate,0.33333333,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nrun,kitti_a,standard,auc_5_deg,score,0.32666667,"), std::string::npos) << csv;
  EXPECT_EQ(csv.find("in_doubt"), std::string::npos) << csv;
  const std::string as_before = MakePaperResult(MakePaperTable(run, {}, TableClusters::kImages)).text;
  EXPECT_EQ(as_before.find("Outcomes"), std::string::npos);
  EXPECT_EQ(as_before.find("in doubt"), std::string::npos);
}

TEST_F(PaperTableOfARun, APairInDoubtIsListedAndInNoOtherColumn) {
  in_doubt_ = 1;
  const PaperTable table = MakePaperTable(Run("run.sqlite"), {}, TableClusters::kImages, {5.0});
  EXPECT_EQ(table.rows[0].num_in_doubt, 1);
  EXPECT_EQ(table.rows.back().num_in_doubt, 1);
  EXPECT_EQ(table.rows[0].cells[0].detect_fail.n, 2);
  EXPECT_EQ(table.rows[0].cells[0].true_failure.n, 2);
  EXPECT_EQ(table.rows[0].cells[0].true_failure.num_events, 0);
  EXPECT_EQ(table.rows[0].cells[0].outcomes[0].success.n, 2);
  const CommandResult result = MakePaperResult(table);
  const std::string &text = result.text, csv = RenderCsv(result.rows);
  EXPECT_NE(text.find("in doubt"), std::string::npos) << text;
  EXPECT_NE(csv.find("\nrun,kitti_a,,truth_in_doubt,rate,0.33333333,,,3,1,"), std::string::npos) << csv;
}

TEST_F(PaperTableOfARun, IsWrittenForPeopleAndPrograms) {
  const PaperTable table =
      MakePaperTable(Run("run.sqlite"), {ParseSceneGroup("mine=room,kit*")}, TableClusters::kImages);
  const CommandResult result = MakePaperResult(table);
  const std::string &text = result.text, csv = RenderCsv(result.rows);
  for (const char* part : {"Detect-fail %", "= mine", "EuRoC/V1_03", "8.33 [", "not significant", "1 of 1"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
  EXPECT_NE(csv.find("run,kitti_a,standard,kappa_failure,rate,0.66666667,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("paper,indoor,Standard,kappa_failure,rate,0.0143520"), std::string::npos) << csv;
  EXPECT_EQ(csv.find("run,room,standard,true_failure"), std::string::npos) << csv;
  const auto json = nlohmann::json::parse(result.json);
  EXPECT_EQ(json["format"], "rcme paper table 1");
  const auto num_rows = static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n'));
  EXPECT_EQ(json["rates"].size() + json["printed"].size() + 1, num_rows);
  for (const auto& rate : json["rates"]) {
    if (rate["scene"] != "kitti_a" || rate["estimator"] != "standard" || rate["quantity"] != "kappa_failure")
      continue;
    EXPECT_NEAR(rate["value"].get<double>(), 2.0 / 3.0, 1e-12);
    EXPECT_EQ(rate["count"], 2);
  }
}

TEST(ParseSceneGroup, NamesAndWhatIsWrong) {
  const SceneGroup group = ParseSceneGroup("indoor=MH_*,room");
  EXPECT_EQ(group.name, "indoor");
  EXPECT_EQ(group.patterns, (std::vector<std::string>{"MH_*", "room"}));
  for (const char* wrong : {"", "indoor", "indoor=", "=room", "indoor=,"})
    EXPECT_TRUE(ThrowsInputError([&] { ParseSceneGroup(wrong); }, {"--group", "NAME=SCENE"})) << wrong;
}

}  // namespace
}  // namespace rcme
