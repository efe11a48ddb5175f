#include "parameters/suggestion.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "parameters/parameter.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

TEST(Suggestion, EditDistancesThatAreKnown) {
  EXPECT_EQ(EditDistance("", ""), 0u);
  EXPECT_EQ(EditDistance("", "abc"), 3u);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(EditDistance("ca", "ac"), 1u) << "neighbours swapped";
  EXPECT_EQ(EditDistance("ca", "abc"), 3u) << "no letter is touched twice";
  EXPECT_EQ(EditDistance("sumarise", "summarize"), 2u);
}

// A metric but for the triangle inequality, which swaps break: symmetric, zero of equal words alone, and at
// most the longer word.
TEST(Suggestion, EditDistanceIsSymmetric) {
  const std::vector<std::string> words = {"",     "a",       "run",     "urn",
                                          "rune", "failure", "failrue", "outlier_ratio"};
  for (const std::string& a : words) {
    for (const std::string& b : words) {
      EXPECT_EQ(EditDistance(a, b), EditDistance(b, a));
      EXPECT_EQ(EditDistance(a, b) == 0, a == b);
      EXPECT_LE(EditDistance(a, b), std::max(a.size(), b.size()));
    }
  }
}

TEST(Suggestion, TheNearestNameOrNone) {
  const std::vector<std::string> names = {"run",       "replay",        "report",
                                          "summarize", "outlier_ratio", "sigma_px"};
  EXPECT_EQ(DidYouMean("sumarize", names), " (did you mean 'summarize'?)");
  EXPECT_EQ(DidYouMean("urn", names), " (did you mean 'run'?)");
  EXPECT_EQ(DidYouMean("outlier-ratio", names), " (did you mean 'outlier_ratio'?)");
  EXPECT_EQ(DidYouMean("Sigma_PX", names), " (did you mean 'sigma_px'?)");
  EXPECT_EQ(DidYouMean("outl", names), " (did you mean 'outlier_ratio'?)") << "the only one that begins so";
  EXPECT_EQ(DidYouMean("rep", names), "") << "two begin so, neither is near";
  EXPECT_EQ(DidYouMean("reprot", names), " (did you mean 'report'?)");
  for (const std::string far : {"frobnicate", "", "x", "moons"}) EXPECT_EQ(DidYouMean(far, names), "") << far;
  EXPECT_EQ(DidYouMean("ratio", names), " (did you mean 'outlier_ratio'?)") << "a part of it";
  EXPECT_EQ(DidYouMean("magsac", {"msac", "opencv_magsac_3_sigma", "opencv_magsac", "opencv_usac"}),
            " (did you mean 'opencv_magsac'?)");
  EXPECT_EQ(DidYouMean("px", names), "") << "too short";
  EXPECT_EQ(DidYouMean(std::string(100000, 'a'), names), "");
  EXPECT_EQ(DidYouMean("run", {}), "");
}

TEST(Suggestion, MessagesHaveIt) {
  double sigma_px = 1.0;
  int which = 0;
  const std::vector<Parameter> parameters = {
      Parameter::Real("sigma_px", &sigma_px, {0.0, 1.0}, "px", ""),
      Parameter::Choice<int>("reading", &which, {{"as_printed", 0}, {"rank_aware", 1}}, "")};
  EXPECT_TRUE(ThrowsInputError([&] { FindParameter(parameters, "sigma_p"); },
                               {"unknown key 'sigma_p' (did you mean 'sigma_px'?); known keys: sigma_px"}));
  EXPECT_TRUE(ThrowsInputError([&] { FindParameter(parameters, "frobs"); }, {"unknown key 'frobs'; known"}));
  EXPECT_TRUE(ThrowsInputError(
      [&] { parameters[1].SetFromText("rank-aware"); },
      {"'rank-aware' is not allowed (did you mean 'rank_aware'?); give one of: as_printed"}));
}

}  // namespace
}  // namespace rcme
