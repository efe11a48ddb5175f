#include "stats/shared_members.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/distributions.h"
#include "stats/moments.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

// Events 1, 1, 0, 0, 0 of pairs ab, bc, cd, de, ab: p = 0.4, u = .6, .6, -.4, -.4, -.4. Sums of a .2, b .8,
// c .2, d -.8, e -.4: squares .04 + .64 + .04 + .64 + .16 = 1.52; of ab (twice the same two) .2, bc .6, cd
// -.4, de -.4: squares .04 + .36 + .16 + .16 = .72. Shared products .8, with 5 / 4 it is 1.0, over n p q
// = 1.2.
TEST(SharedMemberRate, ByHand) {
  const std::vector<PairEvent> pairs = {
      {1, 2, true}, {2, 3, true}, {3, 4, false}, {4, 5, false}, {2, 1, false}};
  SharedMemberRate rate = MeasureSharedMemberRate(pairs);
  EXPECT_EQ(rate.num_events, 2);
  EXPECT_EQ(rate.n, 5);
  EXPECT_EQ(rate.num_members, 5);
  EXPECT_EQ(rate.num_apart, 2);  // ab, cd
  EXPECT_DOUBLE_EQ(rate.rate, 0.4);
  EXPECT_DOUBLE_EQ(rate.design_effect, 1.0);
  EXPECT_DOUBLE_EQ(rate.effective_n, 2.0);
  // The same five at five further places: all sums as before, n doubled, G / (G - 1) = 10 / 9. With another
  // event at ab: p = .6, u = .4, .4, -.6, -.6, .4 each; a .8, b 1.2, c -.2, d -1.2, e -.6: 3.92, less .64 +
  // .16 + .36 + .36 of the pairs, 2.4, twice 4.8; 10 / 9 of it over n p q = 2.4.
  std::vector<PairEvent> twice = pairs;
  twice[4].happened = true;
  for (int i = 0; i < 5; ++i) {
    const PairEvent& one = twice[static_cast<size_t>(i)];
    twice.push_back({one.member1 + 10, one.member2 + 10, one.happened});
  }
  rate = MeasureSharedMemberRate(twice);
  EXPECT_NEAR(rate.design_effect, 4.8 * 10.0 / 9.0 / 2.4, 1e-12);
}

// Without a common member it is nearly the exact binomial interval: u's squares alone remain, and G / (G - 1)
// of n p q.
TEST(SharedMemberRate, OfPairsApartIsNearlyBinomial) {
  std::vector<PairEvent> pairs;
  for (int i = 0; i < 20; ++i) pairs.push_back({2 * i, 2 * i + 1, i < 8});
  const SharedMemberRate rate = MeasureSharedMemberRate(pairs);
  EXPECT_NEAR(rate.design_effect, 20.0 / 19.0, 1e-12);
  EXPECT_EQ(rate.num_apart, 20);
  const Interval exact = ExactBinomialInterval(8, 20);
  EXPECT_NEAR(rate.interval.lower, exact.lower, 0.01);
  EXPECT_NEAR(rate.interval.upper, exact.upper, 0.01);
  for (PairEvent& pair : pairs) pair.happened = false;
  EXPECT_NEAR(MeasureSharedMemberRate(pairs).interval.upper, ExactBinomialInterval(0, 20).upper, 1e-9);
}

// Eleven images of which every two are matched are five pairs apart: nothing that happened tells no more than
// 0 of 5. Clusters (equal members) count once each.
TEST(SharedMemberRate, WhereNothingHappenedPairsApartCount) {
  std::vector<PairEvent> pairs;
  for (int a = 0; a < 11; ++a) {
    for (int b = 0; b < a; ++b) pairs.push_back({a, b, false});
  }
  const SharedMemberRate rate = MeasureSharedMemberRate(pairs);
  EXPECT_EQ(rate.num_apart, 5);
  EXPECT_NEAR(rate.interval.upper, ExactBinomialInterval(0, 5).upper, 1e-9);
  const std::vector<PairEvent> clusters = {{1, 1, false}, {1, 1, false}, {2, 2, false}};
  EXPECT_EQ(MeasureSharedMemberRate(clusters).num_apart, 2);
  EXPECT_TRUE(std::isnan(MeasureSharedMemberRate({}).rate));
  EXPECT_EQ(MeasureSharedMemberRate({}).interval.upper, 1.0);
}

// A sequence of `num_images` whose pairs are neighbours and next but one; an image may be bad, which makes
// its pairs fail more often. True rate: P(z_a + z_b > c) of z with half of the variance each.
std::vector<PairEvent> Sequence(int num_images, double rate, RandomStream& rng) {
  std::vector<double> z(static_cast<size_t>(num_images));
  for (double& x : z) x = rng.Normal() * std::sqrt(0.4);
  const double bound = NormalQuantile(1.0 - rate);
  std::vector<PairEvent> pairs;
  for (int a = 0; a < num_images; ++a) {
    for (int b = a + 1; b <= a + 2 && b < num_images; ++b) {
      const double own = rng.Normal() * std::sqrt(0.2);
      pairs.push_back({a, b, z[static_cast<size_t>(a)] + z[static_cast<size_t>(b)] + own > bound});
    }
  }
  return pairs;
}

// Nominal for approximate intervals of dependent pairs: 0.93 to 1 (exact ones over-cover where events are
// rare); 1,000 sequences of each kind, at 1e-4. The binomial interval of the same counts covers too little
// where many fail: power.
TEST(SharedMemberRate, ItsIntervalCoversWhereImagesAreShared) {
  for (const double rate : {0.01, 0.05, 0.3}) {
    for (const int num_images : {30, 120}) {
      CoverageCount covers, binomial_covers;
      for (std::uint32_t trial = 0; trial < 1000; ++trial) {
        RandomStream rng({.seed = 1, .trial = trial, .purpose = 70});
        const SharedMemberRate measured = MeasureSharedMemberRate(Sequence(num_images, rate, rng));
        covers.Add(measured.interval.Contains(rate));
        binomial_covers.Add(ExactBinomialInterval(measured.num_events, measured.n).Contains(rate));
      }
      EXPECT_GT(covers.interval().upper, 0.94) << rate << " " << num_images << " " << covers;
      EXPECT_GT(covers.rate(), 0.92) << rate << " " << num_images << " " << covers;
      if (rate == 0.3) {
        EXPECT_LT(binomial_covers.interval().upper, 0.93) << binomial_covers;
      }
    }
  }
}

// Of pairs apart exactly Student's interval.
TEST(SharedMemberMean, OfPairsApartIsStudents) {
  const std::vector<PairValue> pairs = {{1, 2, 1.0}, {3, 4, 2.0}, {5, 6, 6.0}};
  const SharedMemberMean mean = MeasureSharedMemberMean(pairs);
  EXPECT_EQ(mean.value, 3.0);
  EXPECT_NEAR(mean.standard_error, std::sqrt(14.0 / 2.0 / 3.0), 1e-12);
  EXPECT_NEAR(mean.interval.upper, 3.0 + 4.302652729911 * mean.standard_error, 1e-9);  // t_2
  EXPECT_TRUE(std::isnan(MeasureSharedMemberMean({}).value));
  EXPECT_TRUE(
      std::isinf(MeasureSharedMemberMean(std::vector<PairValue>{{1, 1, 2.0}, {1, 1, 3.0}}).interval.upper));
  EXPECT_TRUE(
      std::isinf(MeasureSharedMemberMean(std::vector<PairValue>{{1, 2, 2.0}, {2, 1, 3.0}}).interval.upper));
}

// Three pairs apart, each with 50 observations that share half of their variance: 2,000 sets, nominal .95, at
// 1e-4. With five degrees of freedom, those of six members, the same intervals are 2.57 / 4.30 times as wide
// and cover too little: power.
TEST(SharedMemberMean, ItsIntervalCoversWhereFewPairsHaveManyObservations) {
  CoverageCount covers, of_six_covers;
  for (std::uint32_t trial = 0; trial < 2000; ++trial) {
    RandomStream rng({.seed = 2, .trial = trial, .purpose = 70});
    std::vector<PairValue> pairs;
    for (int a = 0; a < 6; a += 2) {
      const double shared = rng.Normal();
      for (int k = 0; k < 50; ++k) pairs.push_back({a, a + 1, shared + rng.Normal()});
    }
    const SharedMemberMean mean = MeasureSharedMemberMean(pairs);
    covers.Add(mean.interval.Contains(0.0));
    of_six_covers.Add(std::abs(mean.value) <= StudentQuantile(5, 0.975) * mean.standard_error);
  }
  EXPECT_TRUE(covers.Admits(0.95)) << covers;
  EXPECT_LT(of_six_covers.interval().upper, 0.92) << of_six_covers;
}

// Values z_a + z_b + own of a sequence's pairs, mean 0: 1,000 sequences, nominal for a sandwich of 40 images
// 0.90 to 1, at 1e-4. Student's interval of the same numbers covers too little: power.
TEST(SharedMemberMean, ItsIntervalCoversWhereImagesAreShared) {
  CoverageCount covers, student_covers;
  for (std::uint32_t trial = 0; trial < 1000; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 70});
    std::vector<double> z(40);
    for (double& x : z) x = rng.Normal();
    std::vector<PairValue> pairs;
    Moments moments;
    for (int a = 0; a + 1 < 40; ++a) {
      for (int b = a + 1; b <= a + 2 && b < 40; ++b) {
        pairs.push_back({a, b, z[static_cast<size_t>(a)] + z[static_cast<size_t>(b)] + rng.Normal()});
        moments.Add(pairs.back().value);
      }
    }
    covers.Add(MeasureSharedMemberMean(pairs).interval.Contains(0.0));
    student_covers.Add(StudentInterval(moments).Contains(0.0));
  }
  EXPECT_GT(covers.interval().upper, 0.92) << covers;
  EXPECT_LT(student_covers.interval().upper, 0.90) << student_covers;
}

// Groups 1 2, 2 3, 3 4 with values 1, 2, 6: two apart, mean 3, squared deviations 14; s^2 = 2 / 1 * 14 / 3,
// the standard error sqrt(s^2 / 2), and t_1 = 12.7062.
TEST(SharedGroupMean, ByHand) {
  const SharedGroupMean mean =
      MeasureSharedGroupMean(std::vector<GroupValue>{{{1, 2}, 1.0}, {{2, 3}, 2.0}, {{3, 4}, 6.0}});
  EXPECT_EQ(mean.n, 3);
  EXPECT_EQ(mean.num_apart, 2);
  EXPECT_DOUBLE_EQ(mean.value, 3.0);
  EXPECT_NEAR(mean.interval.upper - 3.0, 12.706205 * std::sqrt(14.0 / 3.0), 1e-5);
  EXPECT_NEAR(mean.interval.lower + mean.interval.upper, 6.0, 1e-12);
  const SharedGroupMean alone = MeasureSharedGroupMean(std::vector<GroupValue>{{{1, 2}, 1.0}, {{2, 3}, 2.0}});
  EXPECT_EQ(alone.num_apart, 1);
  EXPECT_TRUE(std::isinf(alone.interval.lower) && std::isinf(alone.interval.upper));
  EXPECT_TRUE(std::isnan(MeasureSharedGroupMean({}).value));
}

TEST(SharedGroupRate, IsExactOfGroupsApart) {
  std::vector<GroupValue> groups;
  for (int i = 0; i < 20; ++i) groups.push_back({{2 * i, 2 * i + 1}, i < 8 ? 1.0 : 0.0});
  const Interval exact = ExactBinomialInterval(8, 20);
  const SharedGroupMean apart = MeasureSharedGroupRate(groups);
  EXPECT_DOUBLE_EQ(apart.value, 0.4);
  EXPECT_NEAR(apart.interval.lower, exact.lower, 1e-9);
  EXPECT_NEAR(apart.interval.upper, exact.upper, 1e-9);
  const std::vector<GroupValue> twice = {{{1, 2, 3}, 1.0}, {{3, 4, 5}, 1.0}, {{5, 6, 7}, 1.0}};  // two apart
  EXPECT_NEAR(MeasureSharedGroupRate(twice).interval.lower, ExactBinomialInterval(2, 2).lower, 1e-9);
  EXPECT_EQ(MeasureSharedGroupRate({}).interval.upper, 1.0);
  const std::vector<GroupValue> all(6, {{1}, 1.0});  // a rate of one to the bit
  EXPECT_EQ(MeasureSharedGroupRate(all).value, 1.0);
  EXPECT_EQ(MeasureSharedGroupRate(all).interval.upper, 1.0);
}

// Sums of four consecutive normal numbers of 40: the interval covers their mean, zero, in 95 % or more; one
// that takes the 37 sums for independent covers in less than 75 %.
TEST(SharedGroupMean, CoversWhereGroupsOverlap) {
  CoverageCount allowed_for, ignored;
  for (std::uint32_t trial = 0; trial < 2000; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 96});
    std::vector<double> of_member(40);
    rng.FillNormal(of_member);
    std::vector<GroupValue> groups, independent;
    for (std::int64_t first = 0; first + 4 <= 40; ++first) {
      GroupValue group;
      for (std::int64_t member = first; member < first + 4; ++member) {
        group.members.push_back(member);
        group.value += of_member[static_cast<size_t>(member)];
      }
      groups.push_back(group);
      independent.push_back({{first}, group.value});
    }
    allowed_for.Add(MeasureSharedGroupMean(groups).interval.Contains(0.0));
    ignored.Add(MeasureSharedGroupMean(independent).interval.Contains(0.0));
  }
  EXPECT_GT(allowed_for.interval().upper, 0.95) << allowed_for;
  EXPECT_LT(ignored.interval().upper, 0.75) << ignored;
}

}  // namespace
}  // namespace rcme
