#include "experiments/core/text/field_text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace rcme {
namespace {

TEST(CsvField, QuotesWhatWouldEndACell) {
  EXPECT_EQ(CsvField("rcme_rank-aware.2"), "rcme_rank-aware.2");
  EXPECT_EQ(CsvField(""), "");
  EXPECT_EQ(CsvField("a,b"), "\"a,b\"");
  EXPECT_EQ(CsvField("a\"b"), "\"a\"\"b\"");
  EXPECT_EQ(CsvField("a;=1+1"), "\"a;=1+1\"");  // many spreadsheets separate cells so
  EXPECT_EQ(CsvField("a\tb"), "\"a\tb\"");
}

// What OWASP's "CSV Injection" names: =, +, -, @, tab and carriage return at the beginning.
TEST(CsvField, NoCellBeginsAFormula) {
  EXPECT_EQ(CsvField("=1+1"), "\"'=1+1\"");
  EXPECT_EQ(CsvField("=HYPERLINK(\"http://x\",\"a\")"), "\"'=HYPERLINK(\"\"http://x\"\",\"\"a\"\")\"");
  for (const std::string begin : {"=", "+", "-", "@", "\t", "\r", " =", "＝", "＋", "－", "＠"})
    EXPECT_EQ(CsvField(begin + "cmd|' /C calc'!A0"), "\"'" + begin + "cmd|' /C calc'!A0\"") << begin;
  EXPECT_EQ(CsvField("-"), "\"'-\"");
  EXPECT_EQ(CsvField("'=1"), "\"''=1\"");  // else reading would take the apostrophe off
  EXPECT_EQ(CsvField("-1+1"), "\"'-1+1\"");
}

TEST(CsvField, NumbersStayNumbers) {
  for (const char* number : {"-0.5", "-1e-05", "0", "-900", "1.5"}) EXPECT_EQ(CsvField(number), number);
}

TEST(CsvFields, AreAsTheyWereWritten) {
  const std::vector<std::string> texts = {"plain", "",    "=1+1",     "'=1+1",    "''@x", "-0.5",
                                          "-x",    "a,b", "a\"b\"\"", "'quoted'", "it's", " -x",
                                          "'-5",   "＝x", "\tx",      "last"};
  std::string line;
  for (const std::string& text : texts) line += (line.empty() ? "" : ",") + CsvField(text);
  EXPECT_EQ(CsvFields(line), texts);
  EXPECT_EQ(CsvFields(line + "\r"), texts);
  EXPECT_EQ(CsvFields("a,,b,"), (std::vector<std::string>{"a", "", "b", ""}));
}

}  // namespace
}  // namespace rcme
