#include "experiments/core/text/duration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace rcme {
namespace {

TEST(Duration, IsReadInHoursMinutesAndSeconds) {
  EXPECT_EQ(ParseDuration("90s"), 90.0);
  EXPECT_EQ(ParseDuration("55m"), 3300.0);
  EXPECT_EQ(ParseDuration("1h30m"), 5400.0);
  EXPECT_EQ(ParseDuration("1.5h"), 5400.0);
  EXPECT_EQ(ParseDuration("0.25s"), 0.25);
  for (const std::string wrong : {"", "55", "m", "5d", "1h30", "-5m", "0s", "nan s", "1e9h", " 5m", "5 m"})
    EXPECT_EQ(ParseDuration(wrong), std::nullopt) << wrong;
}

TEST(Duration, WithoutAUnitIsExplained) {
  EXPECT_EQ(ExplainDuration("1h30m"), "");
  for (const std::string text : {"30", "1h30"})
    EXPECT_THAT(ExplainDuration(text),
                testing::AllOf(testing::HasSubstr("'" + text + "' has no unit at its end"),
                               testing::HasSubstr("1h30m or 90s")));
  EXPECT_THAT(ExplainDuration("5d"), testing::HasSubstr("'5d' is not allowed"));
}

}  // namespace
}  // namespace rcme
