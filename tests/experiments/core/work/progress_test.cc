#include "experiments/core/work/progress.h"

#include <gtest/gtest.h>

namespace rcme {
namespace {

TEST(DescribeDuration, KnownAnswers) {
  EXPECT_EQ(DescribeDuration(0.0), "0 s");
  EXPECT_EQ(DescribeDuration(0.2), "1 s");
  EXPECT_EQ(DescribeDuration(59.0), "59 s");
  EXPECT_EQ(DescribeDuration(59.5), "1 min 00 s");
  EXPECT_EQ(DescribeDuration(200.0), "3 min 20 s");
  EXPECT_EQ(DescribeDuration(3599.0), "59 min 59 s");
  EXPECT_EQ(DescribeDuration(7500.0), "2 h 05 min");
}

TEST(Progress, SaysNothingOfShortWork) {
  testing::internal::CaptureStderr();
  {
    Progress progress("trials", 10);
    progress.Advance(10);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace rcme
