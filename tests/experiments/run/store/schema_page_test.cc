// The page of the format (docs/result_file.md) against the schema of the program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "experiments/run/store/schema.h"
#include "tests/test_support/paths.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

std::string TableAsMarkdown(const ResultTable& table) {
  std::string text = fmt::format("### {}\n\n{}\n\n| column | type | unit | meaning |\n|---|---|---|---|\n",
                                 table.name, table.meaning);
  for (const ResultColumn& column : table.columns) {
    const bool is_key = std::ranges::count(table.key, column.name) > 0;
    text += fmt::format("| {}{} | {}{} | {} | {} |\n", column.name, is_key ? " (key)" : "", column.type,
                        column.may_be_null ? " or NULL" : "", column.unit, column.meaning);
  }
  return text + "\n";
}

// The part of the page that follows from the schema, to its end.
std::string SchemaAsMarkdown() {
  std::string text = "## Tables\n\n";
  for (const ResultTable& table : ResultTables()) text += TableAsMarkdown(table);
  text += "## Keys of the table run\n\n| key | meaning |\n|---|---|\n";
  for (const RunKey& key : RunKeys()) text += fmt::format("| {} | {} |\n", key.name, key.meaning);
  return text;
}

TEST(SchemaPage, IsThatOfTheProgram) {
  const std::string page = ReadBytes(SourceFolder() + "/docs/result_file.md");
  EXPECT_NE(page.find(fmt::format("\"{}\"", kResultFormat)), std::string::npos) << kResultFormat;
  const size_t begin = page.find("## Tables\n");
  ASSERT_NE(begin, std::string::npos);
  EXPECT_EQ(page.substr(begin), SchemaAsMarkdown()) << "put the text expected here into docs/result_file.md";
}

TEST(SchemaPage, NoWordIsMissing) {
  std::set<std::string> names;
  for (const ResultTable& table : ResultTables()) {
    EXPECT_TRUE(names.insert(table.name).second);
    EXPECT_FALSE(table.meaning.empty() || table.key.empty()) << table.name;
    for (const ResultColumn& column : table.columns) EXPECT_FALSE(column.meaning.empty()) << column.name;
  }
  for (const std::string& name : DescriptionTables()) EXPECT_EQ(names.count(name), 1u) << name;
}

}  // namespace
}  // namespace rcme
