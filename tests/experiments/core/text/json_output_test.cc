#include "experiments/core/text/json_output.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/test_support/paths.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

std::set<std::string> FormatsIn(const std::string& path) {
  const std::string text = ReadBytes(SourceFolder() + "/" + path);
  const std::regex format("rcme [a-z]+( [a-z]+)* [0-9]+");
  std::set<std::string> formats;
  for (std::sregex_iterator it(text.begin(), text.end(), format), end; it != end; ++it)
    formats.insert(it->str());
  return formats;
}

TEST(JsonText, BeginsWithItsFormat) {
  EXPECT_EQ(JsonText("rcme test 1", {{"b", 1}, {"a", 2}}),
            "{\n \"format\": \"rcme test 1\",\n \"b\": 1,\n \"a\": 2\n}\n");
}

TEST(JsonText, BytesThatAreNoTextAreReplaced) {
  EXPECT_NE(JsonText("rcme test 1", {{"name", "\xff"}}).find("\xEF\xBF\xBD"), std::string::npos);
}

TEST(WriteJson, RowsOneAfterTheOtherAreTheArray) {
  const nlohmann::ordered_json row = {
      {"name", "a\n \"rows\": []"}, {"levels", {{"n", 3}}}, {"interval", {0, 1}}};
  for (const size_t num_rows : {0u, 1u, 5u}) {
    nlohmann::ordered_json object = {
        {"before", row}, {"rows", nlohmann::ordered_json::array()}, {"after", 1}};
    size_t next = 0;
    const auto next_rows = [&] {  // two at a time
      nlohmann::ordered_json rows = nlohmann::ordered_json::array();
      for (const size_t end = std::min(next + 2, num_rows); next < end; ++next) rows.push_back(row);
      return rows;
    };
    std::string text;
    WriteJson("rcme test 1", object, "rows", next_rows, [&](const std::string& piece) { text += piece; });
    for (size_t i = 0; i < num_rows; ++i) object["rows"].push_back(row);
    EXPECT_EQ(text, JsonText("rcme test 1", object)) << num_rows;
  }
}

// The page names every format of the program, and no other.
TEST(JsonText, ThePageHasTheSameFormats) {
  const std::set<std::string> formats = FormatsIn("experiments/core/text/json_output.h");
  EXPECT_EQ(formats.size(), 39u);
  EXPECT_EQ(FormatsIn("docs/output_formats.md"), formats);
}

// What the figures read is what the program writes.
TEST(JsonText, TheFiguresKnowTheSameFormats) {
  for (const auto& [path, format] : {std::pair("plots/audit_figures/audit_file.py", kAuditFormat),
                                     {"plots/tuning_figures/tune_file.py", kTuningFormat},
                                     {"plots/tuning_figures/tune_file.py", kTransferFormat},
                                     {"plots/stanford_figure/integrity_file.py", kIntegrityFormat},
                                     {"plots/gate_figure/gate_file.py", kGateFormat},
                                     {"plots/conform_figure/conform_file.py", kConformReportFormat},
                                     {"plots/trial_sheet/trial_file.py", kTrialFormat},
                                     {"plots/reliability_figure/reliability_file.py", kReliabilityFormat},
                                     {"plots/report_page/data.py", kReportFormat},
                                     {"plots/worst_search/report.py", kWorstFormat}}) {
    EXPECT_EQ(FormatsIn(path).count(format), 1u) << path;
  }
}

}  // namespace
}  // namespace rcme
