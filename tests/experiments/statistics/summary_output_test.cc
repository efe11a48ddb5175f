#include "experiments/statistics/summary_output.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/core/table/render_table.h"
#include "experiments/statistics/quantity_table.h"
#include "experiments/statistics/summary_latex.h"
#include "parameters/input_error.h"
#include "tests/test_support/peak_memory.h"
#include "tests/test_support/summarized_run.h"

namespace rcme {
namespace {

class SummaryOutputTest : public SummarizedRun {};

TEST_F(SummaryOutputTest, ScoresInEveryFormat) {
  const Summary summary = SummarizeRun("run");
  const SummaryRow row = Row("auc_20_deg");
  EXPECT_NE(SummaryAsCsv(summary).find(fmt::format(",auc_20_deg,score,0.3625,{:.8g},{:.8g},,10,betting,,\n",
                                                   row.interval.lower, row.interval.upper)),
            std::string::npos);
  EXPECT_NE(SummaryAsCsv(summary).find(",auc_20_deg,score,,0,1,,0,betting,,\n"), std::string::npos)
      << "no trials";
  EXPECT_NE(SummaryAsCsv(summary).find(",max_error_median_deg,median,15,3,,,10,,,\n"), std::string::npos)
      << "an infinite end is empty";
  const std::string table = SummaryAsTable(summary);
  for (const std::string part : {"auc_5_deg", "maa_10_deg", "max_error_median_deg", "36.25 % ["})
    EXPECT_NE(table.find(part), std::string::npos) << part << table;
  const auto json = nlohmann::json::parse(SummaryAsJson(summary));
  for (const auto& entry : json["rows"]) {
    if (entry["quantity"] != "auc_20_deg" || entry["condition"] != 0) continue;
    EXPECT_EQ(entry["kind"], "score");
    EXPECT_NEAR(entry["value"], 0.3625, 1e-12);
    EXPECT_EQ(entry["interval"][0], row.interval.lower);
    EXPECT_EQ(entry["interval_kind"], "betting");
  }
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST_F(SummaryOutputTest, Csv) {
  const std::vector<std::string> lines = Lines(SummaryAsCsv(SummarizeRun("run")));
  ASSERT_EQ(lines.size(), 1 + SummarizeRun("run").rows.size());
  EXPECT_EQ(lines[0],
            "study,condition,outlier_ratio,estimator,quantity,kind,value,lower,upper,standard_error,n,"
            "interval,verdict,"
            "trials_to_decide");
  EXPECT_EQ(lines[2], "small,0,0,standard,success,rate,0.4,0.12155226,0.73762192,,10,exact,,");
  const auto has_line = [&](const std::string& line) {
    return std::count(lines.begin(), lines.end(), line) == 1;
  };
  EXPECT_TRUE(has_line("small,0,0,standard,rotation_error_deg,mean,2,,,0.40824829,4,,,"));  // sqrt(2 / 3 / 4)
  EXPECT_TRUE(has_line("small,1,0.3,standard,success,rate,,0,1,,0,exact,,"));
  EXPECT_TRUE(has_line("small,1,0.3,standard,nees,mean,,,,,0,,,"));
  for (const std::string& line : lines) EXPECT_EQ(std::count(line.begin(), line.end(), ','), 13) << line;
}

TEST_F(SummaryOutputTest, CsvQuotesWhatNeedsIt) {
  study_.name = "a, \"b\"";
  study_.estimators[0].label = "=1+1";
  Write("quoted", {});
  const std::string csv = SummaryAsCsv(SummarizeRun("quoted"));
  EXPECT_NE(csv.find("\n\"a, \"\"b\"\"\",0,0,\"'=1+1\",success,rate,,0,1,,0,exact,,\n"), std::string::npos)
      << csv;
}

TEST_F(SummaryOutputTest, JsonHoldsTheSameRows) {
  const Summary summary = SummarizeRun("run");
  const nlohmann::json json = nlohmann::json::parse(SummaryAsJson(summary));
  EXPECT_EQ(json["study"], "small");
  EXPECT_EQ(json["trials_done"], 10);
  EXPECT_EQ(json["trials_planned"], 12);
  ASSERT_EQ(json["rows"].size(), summary.rows.size());
  for (size_t i = 0; i < summary.rows.size(); ++i) {
    const SummaryRow& row = summary.rows[i];
    const nlohmann::json& entry = json["rows"][i];
    EXPECT_EQ(entry["condition"], row.condition);
    EXPECT_EQ(entry["levels"]["outlier_ratio"], summary.levels[row.condition][0]);
    EXPECT_EQ(entry["estimator"], row.estimator.text());
    EXPECT_EQ(entry["quantity"], row.quantity.text());
    EXPECT_EQ(entry["n"], row.n);
    EXPECT_EQ(entry["value"].is_null(), row.n == 0);
    if (row.n > 0) {
      EXPECT_EQ(entry["value"], row.value);
    }
    EXPECT_EQ(entry["kind"], KindName(row.kind));
    EXPECT_EQ(entry.contains("verdict"), row.coverage_verdict.has_value());
    if (row.kind == SummaryRow::Kind::kRate) {
      EXPECT_EQ(entry["interval"], nlohmann::json({row.interval.lower, row.interval.upper}));
    } else if (row.kind == SummaryRow::Kind::kMean) {
      EXPECT_EQ(entry["standard_error"].is_null(), std::isnan(row.standard_error));
    }
  }
}

// A row of ten thousand conditions is one of a million: their texts, of 7 MB and 16 MB here, are never whole.
TEST_F(SummaryOutputTest, ManyRowsAreWrittenPieceByPiece) {
  if (!CanMeasurePeakMemory()) GTEST_SKIP() << "this system or build does not tell the peak memory";
  constexpr size_t kNumRows = 60'000;
  constexpr double kBoundMb = 4.0;
  EXPECT_LE(sizeof(SummaryRow), 80u);
  Summary summary = SummarizeRun("run");
  const std::vector<SummaryRow> rows = summary.rows;
  summary.rows.reserve(kNumRows);
  while (summary.rows.size() < kNumRows) summary.rows.push_back(rows[summary.rows.size() % rows.size()]);
  for (const auto write : {WriteSummaryCsv, WriteSummaryJson}) {
    size_t size = 0;
    const auto count = [&](const std::string& piece) { size += piece.size(); };
    EXPECT_LT(PeakMemoryMb([&] { write(summary, count); }), kBoundMb);
    EXPECT_GT(size, size_t{1'000'000});
  }
}

TEST_F(SummaryOutputTest, TableShowsIntervalsAndCounts) {
  const std::string table = SummaryAsTable(SummarizeRun("run"));
  EXPECT_NE(table.find("Study small: 10 of 12 trials done"), std::string::npos) << table;
  EXPECT_NE(table.find("20.00 % [2.52, 55.61]"), std::string::npos) << table;  // failure, 2 of 10
  EXPECT_NE(table.find("Clopper-Pearson"), std::string::npos) << table;
}

TEST_F(SummaryOutputTest, TableSaysThatATargetIsNotReached) {
  Summary summary = SummarizeRun("run");
  summary.is_target_open = true;
  const std::string table = SummaryAsTable(summary);
  EXPECT_NE(table.find("Study small: 10 trials done\nThe target of `rcme run --until` is not reached"),
            std::string::npos)
      << table;
}

TEST_F(SummaryOutputTest, TableOfChosenQuantities) {
  const std::string table = QuantitiesAsTable(SummarizeRun("run"), {"kappa_flag", "failure"});
  EXPECT_NE(table.find("kappa_flag"), std::string::npos) << table;
  EXPECT_NE(table.find("20.00 % [2.52, 55.61]"), std::string::npos) << table;
  EXPECT_EQ(table.find("auc_5_deg"), std::string::npos) << table;
  EXPECT_THROW(QuantitiesAsTable(SummarizeRun("run"), {"failures"}), InputError);
  Summary kept = SummarizeRun("run");
  KeepQuantities({"failure"}, &kept);
  EXPECT_EQ(kept.rows.size(), 2u) << "one per condition";
  EXPECT_THROW(KeepQuantities({"failures"}, &kept), InputError);
}

TEST_F(SummaryOutputTest, LatexHasARowPerConditionAndEstimatorAndIntervals) {
  const std::vector<std::string> lines = Lines(SummaryAsLatex(
      SummarizeRun("run"), {"failure", "nees_median", "rotation_error_deg", "kappa_flag"}, {}));
  ASSERT_EQ(lines.size(), 12u);
  EXPECT_EQ(lines[3], "\\begin{tabular}{llrrrrr}");
  EXPECT_EQ(lines[4], "\\toprule");
  EXPECT_EQ(lines[5],
            "outlier ratio & estimator & $n$ & failure (\\%) & nees median & rotation error deg & "
            "kappa flag (\\%) \\\\");
  EXPECT_EQ(lines[6], "\\midrule");
  EXPECT_TRUE(lines[7].starts_with("0 & standard & 10 & 20.00 [2.52, 55.61] & ")) << lines[7];
  EXPECT_NE(lines[7].find("2 $\\pm$ 0.41 ($n = 4$)"), std::string::npos) << lines[7];
  EXPECT_NE(lines[7].find("16.67 [0.42, 64.12] ($n = 6$) \\\\"), std::string::npos) << lines[7];
  EXPECT_EQ(lines[8], "\\addlinespace");
  EXPECT_EQ(lines[9], "0.3 & standard & 0 & -- & -- & -- & -- \\\\");
  EXPECT_EQ(lines[11], "\\end{tabular}");
}

TEST_F(SummaryOutputTest, PagesShowTheVerdictOnACoverage) {
  const Summary summary = SummarizeRun("run");
  const std::string latex = SummaryAsLatex(summary, {"nees_coverage"}, {});
  EXPECT_NE(latex.find("66.67 [22.28, 95.67] ($n = 6$): undecided \\\\\n"), std::string::npos) << latex;
  EXPECT_NE(latex.find("covers: the whole interval is within 95 +- 1 %."), std::string::npos) << latex;
  const std::string markdown = RenderMarkdown(MakeQuantityTable(summary, {"nees_coverage"}));
  EXPECT_NE(markdown.find("66.67 % [22.28, 95.67] (n 6): undecided, about"), std::string::npos) << markdown;
}

TEST_F(SummaryOutputTest, LatexEscapesEveryNameAndTakesLabels) {
  study_.name = "50 % of_all";
  study_.estimators[0].label = "[a]_b&c\\d~$";
  Write("named", HandMadeRecords());
  const Summary summary = SummarizeRun("named");
  const std::string text = SummaryAsLatex(summary, {"failure"}, {{"outlier_ratio", "share of x_i"}});
  EXPECT_NE(text.find("% Study 50 \\% of\\_all: "), std::string::npos) << text;
  EXPECT_NE(text.find("{[}a]\\_b\\&c\\textbackslash{}d\\textasciitilde{}\\$ & "), std::string::npos) << text;
  EXPECT_NE(text.find("share of x\\_i & estimator"), std::string::npos) << text;
  EXPECT_NE(SummaryAsLatex(summary, {"failure"}, {{"[a]_b&c\\d~$", "Ours"}}).find("0 & Ours & "),
            std::string::npos);
}

TEST_F(SummaryOutputTest, LatexRefusesNamesThatThereAreNot) {
  const Summary summary = SummarizeRun("run");
  EXPECT_THROW(SummaryAsLatex(summary, {"failures"}, {}), InputError);
  EXPECT_THROW(SummaryAsLatex(summary, {"failure"}, {{"sandard", "S"}}), InputError);
  EXPECT_THROW(SummaryAsLatex(summary, {"failure"}, {{"nees_median", "not shown"}}), InputError);
}

TEST_F(SummaryOutputTest, EqualDataGiveEqualBytesInWhateverOrderTheyCame) {
  std::vector<TrialRecord> reversed = HandMadeRecords();
  std::reverse(reversed.begin(), reversed.end());
  for (TrialRecord& record : reversed) record.seconds *= 7.0;
  Write("reversed", reversed);
  EXPECT_EQ(SummaryAsCsv(SummarizeRun("run")), SummaryAsCsv(SummarizeRun("reversed")));
  EXPECT_EQ(SummaryAsJson(SummarizeRun("run")), SummaryAsJson(SummarizeRun("reversed")));
  EXPECT_EQ(SummaryAsTable(SummarizeRun("run")), SummaryAsTable(SummarizeRun("reversed")));
}

// Three problems, the second without a bound: the matches do not determine its motion.
TEST_F(SummaryOutputTest, AMeanWithInfiniteNumbersIsInfiniteEverywhere) {
  std::vector<ProblemRecord> problems(3);
  std::vector<TrialRecord> records;
  for (std::uint32_t i = 0; i < 3; ++i) {
    problems[i].trial = i;
    problems[i].severity.crb_rotation_deg = i == 1 ? std::numeric_limits<double>::infinity() : 0.5;
    records.push_back(Motion(i, 1.0, 1.0, 1.0));
  }
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("infinite"), MakePlan(study_));
    store.Add(problems, records);
  }
  const Summary summary = SummarizeRun("infinite");
  const auto row = std::ranges::find_if(
      summary.rows, [](const SummaryRow& r) { return r.condition == 0 && r.quantity == "crb_rotation_deg"; });
  ASSERT_NE(row, summary.rows.end());
  EXPECT_EQ(row->value, std::numeric_limits<double>::infinity());
  EXPECT_EQ(row->n, 3);
  EXPECT_TRUE(std::isnan(row->standard_error));
  EXPECT_NE(SummaryAsCsv(summary).find("small,0,0,scene,crb_rotation_deg,mean,inf,,,,3,,,\n"),
            std::string::npos);
  const std::string table = SummaryAsTable(summary);
  EXPECT_NE(table.find("  inf"), std::string::npos) << table;
  EXPECT_EQ(table.find("nan"), std::string::npos) << table;
  const nlohmann::json entry =
      nlohmann::json::parse(SummaryAsJson(summary))["rows"][row - summary.rows.begin()];
  EXPECT_EQ(entry["quantity"], "crb_rotation_deg");
  EXPECT_TRUE(entry["value"].is_null());  // JSON has no infinity
  EXPECT_TRUE(entry["standard_error"].is_null());
}

}  // namespace
}  // namespace rcme
