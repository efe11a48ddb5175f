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
