#include "parameters/plain_text.h"

#include <gtest/gtest.h>

#include "parameters/probability_text.h"

namespace rcme {
namespace {

TEST(FindNotPlain, FindsControlCharactersAndWhatIsNotUtf8) {
  EXPECT_EQ(FindNotPlain(""), std::string::npos);
  EXPECT_EQ(FindNotPlain("caf\xC3\xA9\t\n \xF0\x9F\x98\x80"), std::string::npos);
  EXPECT_EQ(FindNotPlain("\xC2\xA0"), std::string::npos);  // no-break space, beside the C1 controls
  EXPECT_EQ(FindNotPlain(std::string("a\0b", 3)), 1u);
  EXPECT_EQ(FindNotPlain("ab\x1B[31m"), 2u);
  EXPECT_EQ(FindNotPlain("\r"), 0u);
  EXPECT_EQ(FindNotPlain("abc\x7F"), 3u);
  EXPECT_EQ(FindNotPlain("a\xC2\x9B"), 1u);  // CSI in one character
  EXPECT_EQ(FindNotPlain("\xC3\xA9\xE9"), 2u);
  EXPECT_EQ(FindNotPlain("a\xE2\x82"), 1u);  // cut off
}

// U+202E turns the direction of what follows: a command that is shown so looks like another.
TEST(FindNotPlain, FindsWhatTurnsTheDirectionOfWriting) {
  for (const char* control : {"\xE2\x80\xA8", "\xE2\x80\xAE", "\xE2\x81\xA6", "\xE2\x81\xA9"})
    EXPECT_EQ(FindNotPlain(std::string("ab") + control), 2u) << Printable(control);
  EXPECT_EQ(FindNotPlain("\xE2\x80\xA7\xE2\x80\xAF\xE2\x81\xA5\xE2\x81\xAA\xE2\x82\xAC"), std::string::npos);
  EXPECT_EQ(Printable("a\xE2\x80\xAE"
                      "b"),
            "a\\xE2\\x80\\xAEb");
}

TEST(FindNotInLine, FindsTabsAndLineEndsToo) {
  EXPECT_EQ(FindNotInLine("a b"), std::string::npos);
  EXPECT_EQ(FindNotInLine("a\tb"), 1u);
  EXPECT_EQ(FindNotInLine("ab\n"), 2u);
  EXPECT_EQ(FindNotInLine("a\x1B\n"), 1u);
}

TEST(Printable, Escapes) {
  EXPECT_EQ(Printable("caf\xC3\xA9 'x'"), "caf\xC3\xA9 'x'");
  EXPECT_EQ(Printable("a\x1B[31m\r\n\tb"), "a\\x1B[31m\\x0D\\n\\x09b");
  EXPECT_EQ(Printable("\xC2\x9B\xE9"), "\\xC2\\x9B\\xE9");
  EXPECT_EQ(Printable(std::string("\0", 1)), "\\x00");
  EXPECT_EQ(Printable(Printable("a\x1B\n")), Printable("a\x1B\n"));  // messages are put into messages
}

TEST(Printable, KeepsBothEndsOfLongText) {
  const std::string text = "begin" + std::string(100'000, 'x') + "end";
  EXPECT_EQ(Printable(text, 10), "begin[... 99998 bytes ...]xxend");
  EXPECT_EQ(Printable("0123456789", 10), "0123456789");
  // No character is cut in two: of 2 bytes each, 4 fit into a half of 9.
  std::string accents;
  for (int i = 0; i < 100; ++i) accents += "\xC3\xA9";
  EXPECT_EQ(FindNotPlain(Printable(accents, 18)), std::string::npos);
  EXPECT_EQ(Printable(accents, 18).find("\\x"), std::string::npos);
}

TEST(Quoted, IsShort) {
  EXPECT_EQ(Quoted("a\x1B"), "'a\\x1B'");
  EXPECT_LT(Quoted(std::string(1 << 20, '\x01')).size(), 1000u);
}

TEST(ProbabilityText, SaysWhereItIsTooSmallToBeTold) {
  EXPECT_EQ(ProbabilityText(0.0), "<1e-05");
  EXPECT_EQ(ProbabilityText(1e-5), "1e-05");
  EXPECT_EQ(ProbabilityText(0.01234), "0.012");
}

}  // namespace
}  // namespace rcme
