#include "experiments/base/columns.h"

#include <gtest/gtest.h>

namespace rcme {
namespace {

TEST(FormatColumns, PadsToTheWidestCell) {
  EXPECT_EQ(FormatColumns({{"a", "bcd"}, {"long", "x"}, {"", "y"}}),
            "a     bcd\n----  ---  \nlong  x\n      y\n");
}

}  // namespace
}  // namespace rcme
