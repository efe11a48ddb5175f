#include "experiments/real/truth_free/loops.h"

#include <gtest/gtest.h>

#include <map>

namespace rcme {
namespace {

std::vector<NamedPair> MakeNamedPairs(const std::vector<std::pair<std::string, std::string>>& images) {
  std::vector<NamedPair> pairs;
  for (const auto& [image1, image2] : images) pairs.push_back({"", image1, image2, {}});
  return pairs;
}

// Where a step begins and ends.
std::pair<std::string, std::string> FindStepEnds(const std::vector<NamedPair>& pairs, const LoopStep& step) {
  const NamedPair& pair = pairs[step.pair];
  return step.is_forward ? std::pair{pair.image1, pair.image2} : std::pair{pair.image2, pair.image1};
}

// Each step begins where the one before it ends, the last ends where the first begins, and no image is met
// twice; in a grid of images with pairs in either direction.
TEST(FindLoops, LeadBackToTheirFirstImage) {
  const std::vector<NamedPair> pairs = MakeNamedPairs({{"a", "b"},
                                                       {"c", "b"},
                                                       {"d", "a"},
                                                       {"e", "b"},
                                                       {"c", "f"},
                                                       {"d", "e"},
                                                       {"f", "e"},
                                                       {"g", "d"},
                                                       {"h", "e"},
                                                       {"g", "h"},
                                                       {"a", "e"}});
  const std::vector<Loop> loops = FindLoops(pairs, 4);
  ASSERT_EQ(loops.size(), 4u);  // 11 pairs of 8 images: a basis has 4
  for (const Loop& loop : loops) {
    std::map<std::string, int> num_met;
    for (size_t k = 0; k < loop.size(); ++k) {
      EXPECT_EQ(FindStepEnds(pairs, loop[k]).second, FindStepEnds(pairs, loop[(k + 1) % loop.size()]).first);
      EXPECT_EQ(++num_met[FindStepEnds(pairs, loop[k]).first], 1);
    }
  }
}

// A ring of five images is a loop of five, not of four; a pair given twice, or of one image, adds none.
TEST(FindLoops, AreOfAtMostTheLongest) {
  std::vector<std::pair<std::string, std::string>> ring = {
      {"a", "b"}, {"b", "c"}, {"c", "d"}, {"d", "e"}, {"e", "a"}};
  EXPECT_TRUE(FindLoops(MakeNamedPairs(ring), 4).empty());
  ASSERT_EQ(FindLoops(MakeNamedPairs(ring), 5).size(), 1u);
  EXPECT_EQ(FindLoops(MakeNamedPairs(ring), 5)[0].size(), 5u);
  ring.insert(ring.end(), {{"b", "a"}, {"a", "b"}, {"c", "c"}, {"", "a"}, {"a", ""}});
  EXPECT_EQ(FindLoops(MakeNamedPairs(ring), 5).size(), 1u);
}

// Six images, each matched with the next three, some pairs turned: loops of three and four go forth by the
// smallest steps and back by one pair; of five there is none. Without the pair of b and c the loop of a goes
// by d.
TEST(FindLoopsOfLength, GoForthBySmallStepsAndBackByOnePair) {
  std::vector<std::pair<std::string, std::string>> window;
  const std::vector<std::string> names = {"a", "b", "c", "d", "e", "f"};
  for (size_t i = 0; i < 6; ++i) {
    for (size_t j = i + 1; j < std::min<size_t>(i + 4, 6); ++j)
      window.push_back(i % 2 == 0 ? std::pair{names[i], names[j]} : std::pair{names[j], names[i]});
  }
  const auto images_of = [](const std::vector<NamedPair>& pairs, size_t length) {
    std::vector<std::string> all;
    for (const Loop& loop : FindLoopsOfLength(pairs, length)) {
      EXPECT_EQ(loop.size(), length);
      std::string images;
      for (size_t k = 0; k < loop.size(); ++k) {
        images += FindStepEnds(pairs, loop[k]).first;
        EXPECT_EQ(FindStepEnds(pairs, loop[k]).second,
                  FindStepEnds(pairs, loop[(k + 1) % loop.size()]).first);
      }
      all.push_back(images);
    }
    return all;
  };
  using Images = std::vector<std::string>;
  const std::vector<NamedPair> pairs = MakeNamedPairs(window);
  EXPECT_EQ(images_of(pairs, 3), (Images{"abc", "bcd", "cde", "def"}));
  EXPECT_EQ(images_of(pairs, 4), (Images{"abcd", "bcde", "cdef"}));
  EXPECT_EQ(images_of(pairs, 5), Images{});
  std::erase(window, std::pair<std::string, std::string>{"c", "b"});
  std::erase(window, std::pair<std::string, std::string>{"b", "c"});
  EXPECT_EQ(images_of(MakeNamedPairs(window), 3), (Images{"abd", "bde", "cde", "def"}));
}

}  // namespace
}  // namespace rcme
