#include "stats/exact_scores.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace rcme {
namespace {

std::vector<double> Uniform(int n) {
  std::mt19937_64 random(3);
  std::vector<double> scores = {0.0, 1.0, 0.5, 0.013};
  while (static_cast<int>(scores.size()) < n)
    scores.push_back(std::uniform_real_distribution<double>()(random));
  return scores;
}

ExactScores ScoresFrom(const std::vector<double>& scores) {
  ExactScores exact;
  for (const double score : scores) exact.Add(score);
  return exact;
}

TEST(ExactScores, BoundTheMeanAsScoresDo) {
  const std::vector<double> scores = Uniform(500);
  ScoreMean mean;
  for (const double score : scores) mean.Add(score);
  const ExactScores exact = ScoresFrom(scores);
  EXPECT_NEAR(exact.moments().mean(), mean.mean(), 1e-15);
  EXPECT_NEAR(exact.Scores().Sequence().lower, mean.Sequence().lower, 1e-9);
  EXPECT_NEAR(exact.Scores().Sequence().upper, mean.Sequence().upper, 1e-9);
  EXPECT_EQ(ExactScores().Scores().Sequence().upper, 1.0);
}

TEST(ExactScores, DoNotDependOnOrderAndGroups) {
  std::vector<double> scores = Uniform(300);
  const ExactScores whole = ScoresFrom(scores);
  std::ranges::reverse(scores);
  EXPECT_EQ(ScoresFrom(scores).Texts(), whole.Texts());
  ExactScores merged = ExactScores::FromTexts(ScoresFrom({scores.begin(), scores.begin() + 100}).Texts());
  merged.Merge(ExactScores());
  merged.Merge(ExactScores::FromTexts(ScoresFrom({scores.begin() + 100, scores.end()}).Texts()));
  EXPECT_EQ(merged.Texts(), whole.Texts());
  EXPECT_EQ(merged.Scores().Sequence().lower, whole.Scores().Sequence().lower);
  EXPECT_EQ(ExactScores::FromTexts(ExactScores().Texts()).Texts(), ExactScores().Texts());
}

TEST(ExactScores, OthersAreRefused) {
  EXPECT_THROW(ExactScores().Add(1.5), std::invalid_argument);
  std::vector<std::string> texts = ScoresFrom({0.25}).Texts();
  EXPECT_NO_THROW(ExactScores::FromTexts(texts));
  texts[3] += " 1";
  EXPECT_THROW(ExactScores::FromTexts(texts), std::invalid_argument);
  texts[3] = "x";
  EXPECT_THROW(ExactScores::FromTexts(texts), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
