#include <gtest/gtest.h>

#include "experiments/real/truth_free/pair_set.h"

namespace rcme {
namespace {

PairAnswers MakeAnsweredPair(const std::string& image1, const std::string& image2) {
  PairAnswers answers;
  answers.whole.pair.image1 = image1;
  answers.whole.pair.image2 = image2;
  return answers;
}

// Images are numbered as they come; a pair without names has a number that no image and no other pair has.
TEST(NumberImages, ByHand) {
  const std::vector<ImageNumbers> numbers =
      NumberImages({MakeAnsweredPair("a", "b"), MakeAnsweredPair("", ""), MakeAnsweredPair("b", "c"),
                    MakeAnsweredPair("c", "a"), MakeAnsweredPair("d", ""), MakeAnsweredPair("e", "e")});
  const std::vector<std::pair<std::int64_t, std::int64_t>> expected = {{0, 1}, {2, 2}, {1, 3},
                                                                       {3, 0}, {4, 4}, {5, 5}};
  ASSERT_EQ(numbers.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(numbers[i].image1, expected[i].first) << i;
    EXPECT_EQ(numbers[i].image2, expected[i].second) << i;
  }
}

}  // namespace
}  // namespace rcme
