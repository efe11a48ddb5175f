#include "experiments/core/files/file_name.h"

#include <gtest/gtest.h>

namespace rcme {
namespace {

TEST(MakeFileName, StaysInItsFolder) {
  EXPECT_EQ(MakeFileName("MH_01-easy.2"), "MH_01-easy.2");
  EXPECT_EQ(MakeFileName("../../etc/cron.d/x"), "_.._.._etc_cron.d_x");
  EXPECT_EQ(MakeFileName("/abs"), "_abs");
  EXPECT_EQ(MakeFileName(".."), "_..");
  EXPECT_EQ(MakeFileName(""), "_");
  EXPECT_EQ(MakeFileName("a b\\c"), "a_b_c");
}

}  // namespace
}  // namespace rcme
