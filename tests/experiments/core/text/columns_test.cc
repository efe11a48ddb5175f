#include "experiments/core/text/columns.h"

#include <gtest/gtest.h>

namespace rcme {
namespace {

TEST(FormatColumns, PadsToTheWidestCell) {
  EXPECT_EQ(FormatColumns({{"a", "bcd"}, {"long", "x"}, {"", "y"}}),
            "a     bcd\n----  ---\nlong  x\n      y\n");
}

TEST(FormatColumns, UnderlinesNoColumnWithoutAHeading) {
  EXPECT_EQ(FormatColumns({{"a", " ", "b"}, {"x", "*", "y"}}), "a     b\n-     -\nx  *  y\n");
}

TEST(FormatNarrowColumns, BreaksTheLastColumnBelowItself) {
  const std::string word(30, 'x');
  EXPECT_EQ(FormatNarrowColumns({{"name", "what"}, {"a", "short"}}),
            FormatColumns({{"name", "what"}, {"a", "short"}}));
  EXPECT_EQ(FormatNarrowColumns({{"name", "what"}, {"a", word + " " + word + " " + word}, {"b", ""}}),
            "name  what\n----  " + std::string(61, '-') + "\na     " + word + " " + word + "\n      " + word +
                "\nb\n");
}

TEST(FormatNarrowColumns, PutsBelowWhatDoesNotFit) {
  const std::string word(50, 'x');
  EXPECT_EQ(
      FormatNarrowColumns(
          {{"name", "unit", "allowed", "what"}, {"a", "px", word, word + " " + word}, {"b", "", "", word}}),
      "name  unit  allowed\n----  ----  " + std::string(50, '-') + "\na     px    " + word + "\n    " + word +
          "\n    " + word + "\nb\n    " + word + "\n");
  const std::string wide(75, 'y');
  EXPECT_EQ(FormatNarrowColumns({{"name", "allowed", "what"}, {"a", wide, "b c"}}),
            "name\n----\na\n    allowed:\n    " + wide + "\n    b c\n");
}

TEST(BreakLines, KeepsWordsWhole) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(BreakLines("ab cd  ef\ngh", 5), (Lines{"ab cd", "ef gh"}));
  EXPECT_EQ(BreakLines("ab cd", 4), (Lines{"ab", "cd"}));
  EXPECT_EQ(BreakLines("a longer word", 3), (Lines{"a", "longer", "word"}));
  EXPECT_EQ(BreakLines("", 3), Lines{""});
}

TEST(FormatParagraph, FitsTheWidthAndKeepsItsIndent) {
  const std::string word(30, 'x');
  EXPECT_EQ(FormatParagraph("  " + word + " " + word + " " + word),
            "  " + word + " " + word + "\n  " + word + "\n");
  const std::string exact = word + " " + word + " " + std::string(kTextWidth - 62, 'y');
  EXPECT_EQ(FormatParagraph(exact), exact + "\n");
  EXPECT_EQ(FormatParagraph(exact + "y"), word + " " + word + "\n" + exact.substr(62) + "y\n");
}

TEST(FormatMarkdown, EscapesWhatEndsACellOrBeginsATag) {
  EXPECT_EQ(FormatMarkdown({{"a", "b"}, {"x|y", "<i> 2*3"}}),
            "| a | b |\n|---|---|\n| x\\|y | \\<i> 2\\*3 |\n");
}

}  // namespace
}  // namespace rcme
