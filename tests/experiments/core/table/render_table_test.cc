#include "experiments/core/table/render_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "stats/constants.h"

namespace rcme {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

// What every renderer has to print: a row of usual values, and one of what is not known or not finite.
Table MakeExample() {
  return {{{.name = "outlier_ratio", .group = "levels", .is_key = true},
           {.name = "estimator", .is_key = true},
           {.name = "n", .type = ColumnType::kCount, .is_symbol = true},
           {.name = "failure", .type = ColumnType::kEstimate, .format = kPercent},
           {.name = "error_deg", .type = ColumnType::kNumber, .heading = "error (deg)"},
           {.name = "lower,upper", .type = ColumnType::kInterval},
           {.name = "trusted", .type = ColumnType::kFlag, .json_name = "is_trusted"}},
          {{std::string("0.3"), std::string("ours"), std::int64_t{1200},
            Estimate{.value = 0.1234, .interval = {0.101, 0.148}, .n = 7, .note = "covers"}, -1.5,
            Interval{-0.5, 2.0}, true},
           {std::string("0.3"), std::string("standard"), std::int64_t{9}, Estimate(), kInf,
            Interval{-kInf, 1.0}, false},
           {std::string("0.5"), std::string("ours"), std::int64_t{0}, std::monostate(), kNaN,
            std::monostate(), std::monostate()}}};
}

TEST(RenderText, AlignsAndMarksWhatIsNotKnown) {
  EXPECT_EQ(
      RenderText(MakeExample(), 200),
      "outlier_ratio  estimator     n  failure                               error (deg)  lower,upper  "
      "trusted\n"
      "-------------  ---------  ----  ------------------------------------  -----------  -----------  "
      "-------\n"
      "0.3            ours       1200  12.34 % [10.10, 14.80] (n 7): covers  -1.5         [-0.5, 2]    yes\n"
      "0.3            standard      9  -                                     inf          [-inf, 1]    no\n"
      "0.5            ours          0                                        -\n");
}

TEST(RenderText, PutsWhatDoesNotFitBelowWithItsKeys) {
  const std::string text = RenderText(MakeExample());
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.find_last_not_of(' ') + 1, kTextWidth) << line;
  }
  EXPECT_NE(text.find("\n\noutlier_ratio  estimator  error (deg)  lower,upper  trusted\n"), std::string::npos)
      << text;
}

TEST(RenderText, BreaksTheNoteOfAnEstimateAndNotItsNumber) {
  const Table table{{{.name = "estimator", .is_key = true},
                     {.name = "coverage", .type = ColumnType::kEstimate, .format = kPercent}},
                    {{std::string("ours"), Estimate{.value = 0.95,
                                                    .interval = {0.8872, 0.9836},
                                                    .note = "undecided, about 6200 trials would do"}}}};
  EXPECT_EQ(RenderText(table, 60),
            "estimator  coverage\n"
            "---------  ---------------------------------------------\n"
            "ours       95.00 % [88.72, 98.36]: undecided, about 6200\n"
            "           trials would do\n");
  EXPECT_NE(RenderText(table, 20).find("95.00 % [88.72, 98.36]:\n"), std::string::npos)
      << RenderText(table, 20);
}

TEST(RenderText, KeepsALabelThatIsTooLong) {
  const std::string label(100, 'x');
  const Table table{{{.name = "estimator", .is_key = true}, {.name = "n", .type = ColumnType::kCount}},
                    {{label, std::int64_t{1}}}};
  EXPECT_NE(RenderText(table).find(label + "  1\n"), std::string::npos) << RenderText(table);
}

TEST(RenderText, BreaksLongTextsAndLineEndsWithinACell) {
  const Table table{{Column::Key("test"), Column::Text("verdict"), Column::Count("n")},
                    {{"halves", "too small, and in simulation it is not", std::int64_t{7}},
                     {"two\nlines", "holds", std::int64_t{12}}}};
  EXPECT_EQ(RenderText(table, 40),
            "test       verdict                n\n"
            "---------  --------------------  --\n"
            "halves     too small, and in      7\n"
            "           simulation it is not\n"
            "two lines  holds                 12\n");
}

TEST(RenderText, LeavesOutOfFurtherBlocksTheRowsThatSayNothingThere) {
  const Table table{{Column::Key("key"), Column::Number("first column"), Column::Text("second column")},
                    {{"x", 1.0, "yes"}, {"y", 2.0, {}}}};
  EXPECT_EQ(RenderText(table, 20),
            "key  first column\n---  ------------\nx    1\ny    2\n\n"
            "key  second column\n---  -------------\nx    yes\n");
  EXPECT_EQ(RenderText({table.columns, {table.rows[1]}}, 20),
            "key  first column\n---  ------------\ny    2\n");
}

TEST(RenderText, BreaksATextWhereTheKeysLeaveLess) {
  const Table table{{Column::Key("key"), Column::Text("text")},
                    {{"twenty-one characters", "four words of 19 ch"}}};
  EXPECT_EQ(RenderText(table, 40),
            "key         text\n----------  ----------------\ntwenty-one  four words of 19\ncharacters  ch\n");
}

// Two draws with 20 keys of their own and a factor with two levels.
TEST(RenderText, LeavesOutLevelsThatTheFirstDeterminesIfTheyAreMany) {
  Table table{{{.name = "draw", .group = "levels", .is_key = true}}, {}};
  for (int k = 0; k < 20; ++k)
    table.columns.push_back({.name = "key_" + std::to_string(k), .group = "levels", .is_key = true});
  table.columns.push_back({.name = "outlier_ratio", .group = "levels", .is_key = true});
  table.columns.push_back({.name = "rate", .type = ColumnType::kNumber});
  for (const std::string draw : {"0", "7"}) {
    for (const std::string ratio : {"0.1", "0.2"}) {
      std::vector<Value> row = {draw};
      for (int k = 0; k < 20; ++k) row.push_back("1" + draw);
      row.insert(row.end(), {ratio, 0.5});
      table.rows.push_back(row);
    }
  }
  EXPECT_EQ(RenderText(table),
            "draw  outlier_ratio  rate\n"
            "----  -------------  ----\n"
            "0     0.1            0.5\n"
            "0     0.2            0.5\n"
            "7     0.1            0.5\n"
            "7     0.2            0.5\n"
            "(draw stands for 20 more columns)\n");
  EXPECT_NE(RenderText(table, 1000).find("key_19"), std::string::npos);
  EXPECT_NE(RenderMarkdown(table).find("key_19"), std::string::npos);
}

TEST(FormatEstimate, SaysHowFarToTrustANumber) {
  EXPECT_EQ(FormatEstimate({.value = 1.234, .standard_error = 0.0456}, kSignificant), "1.23 +- 0.046");
  EXPECT_EQ(FormatEstimate({.value = 1.234, .interval = {1.0, kInf}}, kSignificant), "1.23 [1, inf]");
  EXPECT_EQ(FormatEstimate({.value = 1.234, .interval = {-kInf, kInf}}, kSignificant), "1.23");
  EXPECT_EQ(FormatEstimate({.value = -kInf}, kSignificant), "-inf");
  EXPECT_EQ(FormatEstimate({.n = 3, .note = "covers"}, kPercent), "-");
  EXPECT_EQ(FormatEstimate({.value = 1.2e-6, .interval = {1e-6, 2e-6}, .standard_error = 1e-7}, kPercent),
            "0.00012 % +- 1e-05 [0.0001, 0.0002]");
}

TEST(RenderCsv, HasAllDigitsAndEmptyFields) {
  EXPECT_EQ(RenderCsv(MakeExample()),
            "outlier_ratio,estimator,n,failure,error_deg,lower,upper,trusted\n"
            "0.3,ours,1200,0.1234,-1.5,-0.5,2,yes\n"
            "0.3,standard,9,,inf,,1,no\n"
            "0.5,ours,0,,,,,\n");
}

TEST(RenderCsv, QuotesTextsAndFormulasAndLeavesOutColumnsWithoutAName) {
  const Table table{{{"a\"b"}, {.name = "", .json_name = "only_in_json"}, {"c"}},
                    {{std::string("x, \"y\""), std::string("z"), std::string("=1+1")},
                     {std::string("two\nlines"), std::string("z"), std::string("-3")}}};
  EXPECT_EQ(RenderCsv(table),
            "\"a\"\"b\",c\n"
            "\"x, \"\"y\"\"\",\"'=1+1\"\n"
            "\"two\nlines\",-3\n");
}

TEST(RenderCsv, WritesDigitsAsTheColumnSays) {
  NumberFormat four, shortest;
  four.file = ".4f";
  shortest.file = "";
  EXPECT_EQ(RenderCsv({{Column::Number("a", four),
                        {"b,c", ColumnType::kInterval, four},
                        Column::Estimated("d", four),
                        Column::Number("e", shortest)},
                       {{1.0 / 3.0, Interval{0.0, kInf}, Estimate{.value = 2.0}, 0.1}, {kNaN, {}, {}, 1.0}}}),
            "a,b,c,d,e\n0.3333,0.0000,,2.0000,0.1\n,,,,1\n");
}

TEST(RenderJson, IsAnObjectPerRowWithoutWhatTheRowHasNot) {
  EXPECT_EQ(RenderJson(MakeExample()).dump(),
            R"([{"levels":{"outlier_ratio":"0.3"},"estimator":"ours","n":1200,"failure":0.1234,)"
            R"("error_deg":-1.5,"interval":[-0.5,2.0],"is_trusted":true},)"
            R"({"levels":{"outlier_ratio":"0.3"},"estimator":"standard","n":9,"failure":null,)"
            R"("error_deg":null,"interval":[null,1.0],"is_trusted":false},)"
            R"({"levels":{"outlier_ratio":"0.5"},"estimator":"ours","n":0,"error_deg":null}])");
  EXPECT_EQ(RenderJson({{{.name = "study", .json_name = kNotInJson}}, {{std::string("small")}}}).dump(),
            "[{}]");
}

TEST(RenderLatex, EscapesTextsAndPrintsLevelsWhereTheyChange) {
  Table table = MakeExample();
  table.rows[0][1] = std::string("a_b & 50 %");
  std::get<Estimate>(table.rows[0][3]).note = "7 of 10 %";
  EXPECT_EQ(RenderLatex(table),
            "\\begin{tabular}{llrrrrr}\n\\toprule\n"
            "outlier\\_ratio & estimator & $n$ & failure (\\%) & error (deg) & lower,upper & trusted \\\\\n"
            "\\midrule\n"
            "0.3 & a\\_b \\& 50 \\% & 1200 & 12.34 [10.10, 14.80] ($n = 7$): 7 of 10 \\% & "
            "$-$1.5 & [$-$0.5, 2] & yes \\\\\n"
            " & standard & 9 & -- & $\\infty$ & [$-$$\\infty$, 1] & no \\\\\n"
            "\\addlinespace\n"
            "0.5 & ours & 0 &  & -- &  &  \\\\\n"
            "\\bottomrule\n\\end{tabular}\n");
}

TEST(RenderMarkdown, EscapesPipesAndKeepsARowOnOneLine) {
  EXPECT_EQ(RenderMarkdown({{{"a|b"}, {"c", ColumnType::kEstimate, kPercent}},
                            {{std::string("x|y\n<i>"), Estimate{.value = 0.5, .interval = {0.25, 0.75}}}}}),
            "| a\\|b | c |\n|---|---|\n| x\\|y \\<i> | 50.00 % [25.00, 75.00] |\n");
}

TEST(RenderTable, AnEmptyTableIsItsHeadings) {
  const Table table{{{"a"}, {"b", ColumnType::kCount}}, {}};
  EXPECT_EQ(RenderText(table), "a  b\n-  -\n");
  EXPECT_EQ(RenderCsv(table), "a,b\n");
  EXPECT_EQ(RenderJson(table).dump(), "[]");
  EXPECT_EQ(RenderMarkdown(table), "| a | b |\n|---|---|\n");
  EXPECT_EQ(RenderLatex(table),
            "\\begin{tabular}{lr}\n\\toprule\na & b \\\\\n\\midrule\n\\bottomrule\n\\end{tabular}\n");
}

}  // namespace
}  // namespace rcme
