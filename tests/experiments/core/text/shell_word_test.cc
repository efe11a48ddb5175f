#include "experiments/core/text/shell_word.h"

#include <gtest/gtest.h>

namespace rcme {
namespace {

TEST(QuoteForShell, QuotesWhatAShellWouldChange) {
  EXPECT_EQ(QuoteForShell("corridor/run-2.sqlite"), "corridor/run-2.sqlite");
  EXPECT_EQ(QuoteForShell("my dir"), "'my dir'");
  EXPECT_EQ(QuoteForShell("it's"), "'it'\\''s'");
  EXPECT_EQ(QuoteForShell("$HOME"), "'$HOME'");
  EXPECT_EQ(QuoteForShell("~"), "'~'");
  EXPECT_EQ(QuoteForShell(""), "''");
}

}  // namespace
}  // namespace rcme
