#include "experiments/core/text/columns.h"

#include <gtest/gtest.h>

namespace rcme {
namespace {

TEST(FormatColumns, PadsToTheWidestCell) {
  EXPECT_EQ(FormatColumns({{"a", "bcd"}, {"long", "x"}, {"", "y"}}),
            "a     bcd\n----  ---  \nlong  x\n      y\n");
}

TEST(FormatMarkdown, EscapesWhatEndsACellOrBeginsATag) {
  EXPECT_EQ(FormatMarkdown({{"a", "b"}, {"x|y", "<i> 2*3"}}),
            "| a | b |\n|---|---|\n| x\\|y | \\<i> 2\\*3 |\n");
}

}  // namespace
}  // namespace rcme
