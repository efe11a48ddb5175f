// Lines of a text from outside: their limits, and what is no end of it.
#include "parameters/text_lines.h"

#include <gtest/gtest.h>

#include <new>
#include <string>
#include <vector>

#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

std::vector<std::string> ReadLines(const std::string& text, const TextLimits& limits = {1000, 1000}) {
  TextLines lines("text", ReadFrom(text), limits);
  std::vector<std::string> all;
  for (std::string_view line; lines.Next(&line);) all.emplace_back(line);
  return all;
}

using Lines = std::vector<std::string>;

TEST(TextLines, AreThoseOfGetline) {
  EXPECT_EQ(ReadLines(""), Lines{});
  EXPECT_EQ(ReadLines("\n"), Lines{""});
  EXPECT_EQ(ReadLines("a"), Lines{"a"});
  EXPECT_EQ(ReadLines("a\n\nb\n"), (Lines{"a", "", "b"}));
  const std::string longer(100'000, 'x');  // than the buffer
  EXPECT_EQ(ReadLines(longer + "\n" + longer, {200'000, 1 << 20}), (Lines{longer, longer}));
}

TEST(TextLines, AreNotFollowedFar) {
  EXPECT_EQ(ReadLines("1234\n", {4, 100}), Lines{"1234"});
  EXPECT_TRUE(ThrowsInputError(
      [] {
        ReadLines("1\n12345\n", {4, 100});
      },
      {"text:2: the line is too long; at most 4 bytes"}));
  EXPECT_TRUE(ThrowsInputError([] { ReadLines("1\n2\n3\n", {4, 5}); }, {"text:3: the text is too long"}));
  size_t num_read = 0;
  const auto endless = [&](char* buffer, size_t size) {
    std::fill_n(buffer, size, '\0');
    num_read += size;
    return size;
  };
  std::string_view line;
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        TextLines("/dev/zero", endless, {1 << 20, 1 << 24}).Next(&line);
      },
      {"/dev/zero:1"}));
  EXPECT_LT(num_read, size_t{2} << 20);
}

// std::getline would end the text here.
TEST(TextLines, AFailedAllocationOrReadIsNoEnd) {
  const auto no_memory = [](char*, size_t) -> size_t { throw std::bad_alloc(); };
  std::string_view line;
  EXPECT_THROW(TextLines("text", no_memory, {10, 10}).Next(&line), std::bad_alloc);
}

TEST(SplitText, AnEmptyLastPartDoesNotCount) {
  EXPECT_EQ(SplitText("", ','), Lines{});
  EXPECT_EQ(SplitText(",", ','), Lines{""});
  EXPECT_EQ(SplitText("a,,b,", ','), (Lines{"a", "", "b"}));
}

}  // namespace
}  // namespace rcme
