#include "estimator/candidate_set.h"

#include <gtest/gtest.h>

#include "stats/random.h"

namespace rcme {
namespace {

constexpr int kNumMatches = 100;

Candidate Make(int num_inliers, double mean_entropy, int tag = 0) {
  Candidate candidate;
  candidate.id.sample = {tag};
  candidate.score.num_inliers = num_inliers;
  candidate.score.mean_entropy = mean_entropy;
  return candidate;
}

RansacOptions GivenRatio(double inlier_ratio, double lambda) {
  RansacOptions options;
  options.inlier_ratio = inlier_ratio;
  options.lambda = lambda;
  return options;
}

TEST(CandidateSet, EmptySelectsNothing) {
  const CandidateSet candidates(RansacOptions(), kNumMatches);
  EXPECT_EQ(candidates.CountMembers(), 0);
  EXPECT_TRUE(candidates.SelectBest(1, DecidingScore::kMeanEntropy).empty());
}

TEST(CandidateSet, GivenRatioDecidesTheSizeCondition) {
  // n_j / n >= lambda omega_p = 0.5 * 0.8 = 0.4, the bound included.
  CandidateSet candidates(GivenRatio(0.8, 0.5), kNumMatches);
  EXPECT_TRUE(candidates.MeetsSizeCondition(Make(40, 0.0)));
  EXPECT_FALSE(candidates.MeetsSizeCondition(Make(39, 0.0)));
  candidates.Add(Make(39, -5.0));
  candidates.Add(Make(40, 1.0, 1));
  candidates.Add(Make(90, 2.0, 2));  // must not raise the given omega_p
  EXPECT_EQ(candidates.CountMembers(), 2);
  EXPECT_EQ(candidates.SelectBest(1, DecidingScore::kMeanEntropy).at(0).id.sample[0], 1)
      << "the best entropy is too small a set";
  EXPECT_EQ(candidates.SelectBest(1, DecidingScore::kNumInliers).at(0).id.sample[0], 2);
}

TEST(CandidateSet, InferredRatioIsTheLargestShareOfAllThatPassed) {
  RansacOptions options;
  options.lambda = 0.5;
  CandidateSet candidates(options, kNumMatches);
  candidates.Add(Make(20, -9.0, 1));
  EXPECT_EQ(candidates.CountMembers(), 1);
  EXPECT_EQ(candidates.SelectBest(1, DecidingScore::kMeanEntropy).at(0).id.sample[0], 1);
  candidates.Add(Make(60, 3.0, 2));  // now at least 30 are needed: the first one is out again
  EXPECT_EQ(candidates.CountMembers(), 1);
  EXPECT_EQ(candidates.SelectBest(1, DecidingScore::kMeanEntropy).at(0).id.sample[0], 2);
  candidates.Add(Make(30, 0.0, 3));
  candidates.Add(Make(29, -1.0, 4));
  EXPECT_EQ(candidates.CountMembers(), 2);
  EXPECT_EQ(candidates.SelectBest(1, DecidingScore::kMeanEntropy).at(0).id.sample[0], 3);
}

TEST(CandidateSet, LargestLambdaKeepsTheLargestSetAlone) {
  CandidateSet candidates(GivenRatio(std::numeric_limits<double>::quiet_NaN(), 1.0), kNumMatches);
  candidates.Add(Make(59, -9.0, 1));
  candidates.Add(Make(60, 3.0, 2));
  EXPECT_EQ(candidates.CountMembers(), 1);
  EXPECT_EQ(candidates.SelectBest(1, DecidingScore::kMeanEntropy).at(0).id.sample[0], 2);
}

TEST(CandidateSet, LargestSetIsAlwaysAMember) {
  // lambda omega_p n in floating point must not shut out the very set that omega_p was inferred from.
  RansacOptions options;
  options.lambda = 1.0;
  for (int n = 8; n <= 2000; ++n) {
    for (const int num_inliers : {n, n - 1, n / 2, n / 3, 7}) {
      CandidateSet candidates(options, n);
      candidates.Add(Make(num_inliers, 0.0));
      ASSERT_EQ(candidates.CountMembers(), 1) << num_inliers << " of " << n;
    }
  }
}

TEST(CandidateSet, FirstOneWinsATie) {
  CandidateSet candidates(GivenRatio(0.1, 0.5), kNumMatches);
  candidates.Add(Make(50, 1.0, 1));
  candidates.Add(Make(50, 1.0, 2));
  EXPECT_EQ(candidates.SelectBest(1, DecidingScore::kMeanEntropy).at(0).id.sample[0], 1);
  EXPECT_EQ(candidates.SelectBest(1, DecidingScore::kNumInliers).at(0).id.sample[0], 1);
}

// The tags in the order of selection: the best first, the earlier one at a tie, no more than there are.
TEST(CandidateSet, SelectsTheBestInOrder) {
  CandidateSet candidates(GivenRatio(0.1, 0.5), kNumMatches);
  const double entropies[] = {4.0, 1.0, 3.0, 1.0, 2.0, 3.0, 0.0};
  for (int i = 0; i < 7; ++i)
    candidates.Add(Make(i == 6 ? 4 : 50, entropies[i], i));  // the last is too small
  const auto tags = [&](int count) {
    std::vector<int> first_matches;
    for (const Candidate& candidate : candidates.SelectBest(count, DecidingScore::kMeanEntropy))
      first_matches.push_back(candidate.id.sample[0]);
    return first_matches;
  };
  EXPECT_EQ(tags(1), (std::vector<int>{1}));
  EXPECT_EQ(tags(4), (std::vector<int>{1, 3, 4, 2}));
  EXPECT_EQ(tags(6), (std::vector<int>{1, 3, 4, 2, 5, 0}));
  EXPECT_EQ(tags(100), tags(6));
}

TEST(CandidateSet, SelectsTheLeastOfMany) {
  RandomStream rng({.seed = 1, .purpose = 130});
  CandidateSet candidates(GivenRatio(0.5, 1.0), kNumMatches);
  double least = std::numeric_limits<double>::infinity();
  int num_members = 0;
  for (int i = 0; i < 5000; ++i) {
    const Candidate candidate = Make(static_cast<int>(rng.IntegerBelow(101)), rng.Normal(), i);
    candidates.Add(candidate);
    if (candidate.score.num_inliers < 50) continue;
    ++num_members;
    least = std::min(least, candidate.score.mean_entropy);
  }
  EXPECT_EQ(candidates.CountMembers(), num_members);
  EXPECT_EQ(candidates.SelectBest(1, DecidingScore::kMeanEntropy).at(0).score.mean_entropy, least);
}

}  // namespace
}  // namespace rcme
