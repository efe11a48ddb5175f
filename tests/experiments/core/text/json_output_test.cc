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
  const std::regex format("rcme [a-z]+ [0-9]+");
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

// The page names every format of the program, and no other.
TEST(JsonText, ThePageHasTheSameFormats) {
  const std::set<std::string> formats = FormatsIn("experiments/core/text/json_output.h");
  EXPECT_EQ(formats.size(), 21u);
  EXPECT_EQ(FormatsIn("docs/output_formats.md"), formats);
}

// What the figures read is what the program writes.
TEST(JsonText, TheFiguresKnowTheSameFormats) {
  for (const auto& [path, format] : {std::pair("plots/audit_figures/audit_file.py", kAuditFormat),
                                     {"plots/tuning_figures/tune_file.py", kTuningFormat},
                                     {"plots/tuning_figures/tune_file.py", kTransferFormat},
                                     {"plots/stanford_figure/integrity_file.py", kIntegrityFormat},
                                     {"plots/trial_sheet/trial_file.py", kTrialFormat},
                                     {"plots/reliability_figure/reliability_file.py", kReliabilityFormat},
                                     {"plots/report_page/data.py", kReportFormat},
                                     {"plots/worst_search/report.py", kWorstFormat}}) {
    EXPECT_EQ(FormatsIn(path).count(format), 1u) << path;
  }
}

}  // namespace
}  // namespace rcme
