#include "stats/area_under_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

TEST(AreaUnderCurve, KnownAnswers) {
  // By the definitions, kernel by kernel:  python3 tests/known_answers/samples.py  (ties in and between the
  // samples)
  const AreaUnderCurve area = MeasureAreaUnderCurve({1, 2, 2, 3, 4, 4, 5, 7}, {2, 4, 5, 6, 6, 8, 9});
  EXPECT_NEAR(area.value, 0.776785714286, 1e-12);
  EXPECT_NEAR(area.standard_error, 0.128356301505, 1e-12);
  EXPECT_NEAR(area.interval.lower, 0.348484860455, 1e-9);
  EXPECT_NEAR(area.interval.upper, 0.939371417546, 1e-9);
  // The same scores in clusters, two of which hold both kinds and one only negatives.
  const AreaUnderCurve clustered =
      MeasureClusteredAreaUnderCurve({{{1, 2, 2}, {2, 4}}, {{3, 4}, {}}, {{4}, {5, 6, 6}}, {{5, 7}, {8, 9}}});
  EXPECT_NEAR(clustered.value, area.value, 1e-15);
  EXPECT_NEAR(clustered.standard_error, 0.075654441007, 1e-12);
  EXPECT_NEAR(clustered.interval.lower, 0.093172443696, 1e-9);
  EXPECT_NEAR(clustered.interval.upper, 0.982756213287, 1e-9);
}

// A tie at infinity is half a pair in order, as any other; nothing of it is NaN.
TEST(AreaUnderCurve, TiesAtInfinityCountOneHalf) {
  const AreaUnderCurve finite = MeasureAreaUnderCurve({-9, 1, 2, 9, 9}, {-9, 2, 9, 3});
  const AreaUnderCurve infinite =
      MeasureAreaUnderCurve({-kInfinity, 1, 2, kInfinity, kInfinity}, {-kInfinity, 2, kInfinity, 3});
  EXPECT_EQ(infinite.value, finite.value);
  EXPECT_EQ(infinite.standard_error, finite.standard_error);
  EXPECT_EQ(infinite.interval.lower, finite.interval.lower);
  // By hand, of 20 pairs: -inf ties one; 2 beats two and ties one; inf beats three and ties two; 3 beats
  // three.
  EXPECT_DOUBLE_EQ(infinite.value, (0.5 + 2.5 + 4.0 + 3.0) / 20.0);
  EXPECT_EQ(MeasureAreaUnderCurve({kInfinity, kInfinity}, {kInfinity, kInfinity}).value, 0.5);
}

// Counting two infinite scores as out of order (0) or in order (1) would bias the area.
TEST(AreaUnderCurve, OfATieACoinSaysWhichIsBelow) {
  RandomStream rng({.seed = 1, .purpose = 144});
  CoverageCount infinite, finite;
  for (int i = 0; i < 4000; ++i) {
    infinite.Add(IsBelow(kInfinity, kInfinity, rng));
    finite.Add(IsBelow(2.0, 2.0, rng));
    ASSERT_TRUE(IsBelow(1.0, kInfinity, rng));
    ASSERT_FALSE(IsBelow(kInfinity, 1.0, rng));
    ASSERT_TRUE(IsBelow(1.0, 2.0, rng));
  }
  EXPECT_TRUE(infinite.Admits(0.5)) << infinite;
  EXPECT_FALSE(infinite.Admits(0.45)) << "no power";
  EXPECT_TRUE(finite.Admits(0.5)) << finite;
}

TEST(AreaUnderCurve, PerfectSeparationIsNotCertainty) {
  const AreaUnderCurve perfect = MeasureAreaUnderCurve({1, 2, 3, 4}, {5, 6, 7});
  EXPECT_EQ(perfect.value, 1.0);
  EXPECT_EQ(perfect.standard_error, 0.0);
  EXPECT_NEAR(perfect.interval.lower, std::cbrt(0.025), 1e-14) << "three pairs";
  EXPECT_EQ(perfect.interval.upper, 1.0);
  const AreaUnderCurve reversed = MeasureAreaUnderCurve({5, 6, 7}, {1, 2, 3, 4});
  EXPECT_EQ(reversed.value, 0.0);
  EXPECT_NEAR(reversed.interval.upper, 1.0 - perfect.interval.lower, 1e-12);
  // Four scenes that hold both kinds make two pairs of scenes, none used twice.
  const AreaUnderCurve scenes =
      MeasureClusteredAreaUnderCurve({{{1, 2}, {5}}, {{3}, {6}}, {{2}, {7, 8}}, {{1}, {9}}});
  EXPECT_NEAR(scenes.interval.lower, std::sqrt(0.025), 1e-14);
  EXPECT_EQ(MeasureAreaUnderCurve({1, 1, 1}, {1, 1}).value, 0.5) << "equal scores are chance";
}

TEST(AreaUnderCurve, OneClusterTellsNothing) {
  const AreaUnderCurve area = MeasureClusteredAreaUnderCurve({{{1, 2, 3}, {2, 3, 4}}});
  EXPECT_NEAR(area.value, 7.0 / 9.0, 1e-15);
  EXPECT_TRUE(std::isnan(area.standard_error));
  EXPECT_EQ(area.interval.lower, 0.0);
  EXPECT_EQ(area.interval.upper, 1.0);
}

// 20 positives of three times the spread against 200 negatives, an area of 0.95: 2,000 repetitions. The plain
// interval of DeLong's standard error, which this replaces, covers 0.75 here.
TEST(AreaUnderCurve, CoversWithFewPositives) {
  const double shift = std::sqrt(10.0) * NormalQuantile(0.95);
  CoverageCount covered, plain;
  RandomStream rng({.seed = 1, .purpose = 140});
  std::vector<double> negatives(200), positives(20);
  for (int repetition = 0; repetition < 2000; ++repetition) {
    for (double& x : negatives) x = rng.Normal();
    for (double& x : positives) x = shift + 3.0 * rng.Normal();
    const AreaUnderCurve area = MeasureAreaUnderCurve(negatives, positives);
    covered.Add(area.interval.Contains(0.95));
    plain.Add(std::abs(area.value - 0.95) <= 1.96 * area.standard_error);
  }
  EXPECT_GT(covered.interval().upper, 0.95) << covered;
  EXPECT_GT(covered.rate(), 0.93) << covered;
  EXPECT_LT(plain.rate(), 0.85) << plain;
}

// 25 scenes of four positives and four negatives, half of the variance from an effect of scene and kind:
// 2,000 repetitions. Scores taken as independent cover 0.79.
TEST(AreaUnderCurve, CoversWhereScoresShareAScene) {
  const double shift = std::sqrt(2.0) * NormalQuantile(0.8);
  CoverageCount covered, as_independent;
  RandomStream rng({.seed = 1, .purpose = 141});
  for (int repetition = 0; repetition < 2000; ++repetition) {
    std::vector<ScoreCluster> clusters(25);
    std::vector<double> negatives, positives;
    for (ScoreCluster& cluster : clusters) {
      const double of_negatives = rng.Normal(), of_positives = rng.Normal();
      for (int i = 0; i < 4; ++i) {
        cluster.negatives.push_back(std::sqrt(0.5) * (of_negatives + rng.Normal()));
        cluster.positives.push_back(shift + std::sqrt(0.5) * (of_positives + rng.Normal()));
      }
      negatives.insert(negatives.end(), cluster.negatives.begin(), cluster.negatives.end());
      positives.insert(positives.end(), cluster.positives.begin(), cluster.positives.end());
    }
    covered.Add(MeasureClusteredAreaUnderCurve(clusters).interval.Contains(0.8));
    as_independent.Add(MeasureAreaUnderCurve(negatives, positives).interval.Contains(0.8));
  }
  EXPECT_GT(covered.interval().upper, 0.95) << covered;
  EXPECT_LT(covered.interval().lower, 0.97) << covered;
  EXPECT_LT(as_independent.rate(), 0.87) << as_independent;
}

TEST(AreaUnderCurve, HasPower) {
  // A shift of 0.4 sigma (area 0.61), 200 of each kind, is distinguished from chance with power above 0.9.
  CoverageCount caught;
  RandomStream rng({.seed = 1, .purpose = 143});
  for (int repetition = 0; repetition < 1000; ++repetition) {
    std::vector<double> negatives(200), positives(200);
    for (double& x : negatives) x = rng.Normal();
    for (double& x : positives) x = 0.4 + rng.Normal();
    caught.Add(MeasureAreaUnderCurve(negatives, positives).interval.lower > 0.5);
  }
  EXPECT_GT(caught.interval().lower, 0.9) << caught;
}

TEST(AreaUnderCurve, BadInput) {
  EXPECT_THROW(MeasureAreaUnderCurve({1.0}, {}), std::invalid_argument);
  EXPECT_THROW(MeasureAreaUnderCurve({1.0, std::nan("")}, {1.0}), std::invalid_argument);
  EXPECT_THROW(MeasureClusteredAreaUnderCurve(std::vector<ScoreCluster>{}), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
