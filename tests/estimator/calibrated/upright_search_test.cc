#include "estimator/calibrated/upright_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "estimator/geometry/essential_matrix.h"
#include "stats/constants.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// A vector turned by isotropic noise, per tangent axis.
Eigen::Vector3d MeasureDown(const Eigen::Vector3d& down, double sd_deg, RandomStream& rng) {
  const Eigen::Vector2d noise(rng.Normal(), rng.Normal());
  return (down + sd_deg * kRadPerDeg * DirectionBasis(down) * noise).normalized();
}

struct UprightProblem {
  MotionProblem problem;
  RelativePose pose_true;
  MotionPrior motion;
};

UprightProblem MakeUprightProblem(double outlier_ratio, double sd_deg, std::uint32_t trial) {
  UprightProblem made;
  made.problem = TwoCameraProblem(200, 0.5, outlier_ratio, trial, &made.pose_true);
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 4190});
  const Eigen::Vector3d down = Eigen::Vector3d::UnitY();
  made.motion.gravity = {MeasureDown(down, sd_deg, rng), MeasureDown(made.pose_true.R * down, sd_deg, rng),
                         sd_deg * kRadPerDeg, sd_deg * kRadPerDeg};
  return made;
}

// The candidates of `num_samples` samples of five matches, then also of a quarter as many of three.
struct BothSearches {
  HypothesisSearch five, both;
};
BothSearches SearchBoth(const UprightProblem& made, int num_samples, std::uint32_t trial) {
  const MatchBlocks matches(made.problem);
  const ScoreMatches score_matches(matches);
  const MixturePrior prior{1e-3, true, &made.motion};
  CalibratedOptions options;
  options.min_samples = options.max_samples = num_samples;
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 4191});
  BothSearches found;
  found.five = found.both = SearchHypotheses(matches, score_matches, options, rng, kSoftScale, &made.motion);
  AddUprightCandidates(matches, score_matches, prior, num_samples / 4, 4, rng, &found.both);
  return found;
}

// |<E_a, E_b>| / 2: 1 for the same motion, about 1 - (x / 2)^2 for an angle x between their directions.
bool HasTruth(const HypothesisSearch& search, const RelativePose& pose_true) {
  const Eigen::Matrix3d E_true = EssentialFromPose(pose_true);
  return std::ranges::any_of(search.candidates, [&](const ScoredEssential& candidate) {
    return 0.5 * std::abs(candidate.E.cwiseProduct(E_true).sum()) > 0.99;
  });
}

struct RatesOfTruth {
  CoverageCount five, both;
};
RatesOfTruth CountTruth(double outlier_ratio, double sd_deg, std::uint32_t num_trials) {
  constexpr int kSamples = 1000;
  RatesOfTruth rates;
  for (std::uint32_t trial = 0; trial < num_trials; ++trial) {
    const UprightProblem made = MakeUprightProblem(outlier_ratio, sd_deg, trial);
    const BothSearches found = SearchBoth(made, kSamples, trial);
    rates.five.Add(HasTruth(found.five, made.pose_true));
    rates.both.Add(HasTruth(found.both, made.pose_true));
  }
  return rates;
}

// 85 % wrong, 1000 samples of five matches: one of them is all right with probability .073, one of 250
// samples of three with .57. Others come near enough, also with the help of the refinement: over 1000 trials
// the truth was among the candidates of five matches in 24 %, with those of three in 91 % if gravity is known
// to 0.1 deg and in 65 % if to 2 deg. At these rates the bounds are missed with a probability below 1e-4.
// Ranked at the scale of the noise, the last rate would be 52 %; without refinement 41 %.
TEST(UprightSearch, FindsTheMotionWhereFiveMatchesAreSeldomRight) {
  const RatesOfTruth good = CountTruth(0.85, 0.1, 200), rough = CountTruth(0.85, 2.0, 600);
  EXPECT_LT(good.five.rate(), 0.4) << good.five;
  EXPECT_GT(good.both.rate(), 0.8) << good.both;
  EXPECT_GT(rough.both.rate(), 0.57) << rough.both;
}

void ExpectSameCandidates(const HypothesisSearch& a, const HypothesisSearch& b) {
  ASSERT_EQ(a.candidates.size(), b.candidates.size());
  for (size_t i = 0; i < a.candidates.size(); ++i) {
    EXPECT_EQ(a.candidates[i].E, b.candidates[i].E);
    EXPECT_EQ(a.candidates[i].score, b.candidates[i].score);
  }
}

// Neither candidates nor random numbers change.
TEST(UprightSearch, DoesNothingWithoutAUsefulMeasurementOfGravity) {
  const UprightProblem made = MakeUprightProblem(0.5, 0.1, 1);
  const MatchBlocks matches(made.problem);
  const ScoreMatches score_matches(matches);
  RandomStream search_rng({.seed = 1, .purpose = 4192});
  const HypothesisSearch before = SearchHypotheses(matches, score_matches, {}, search_rng);
  MotionPrior no_gravity = made.motion, rough = made.motion;
  no_gravity.gravity.reset();
  no_gravity.rotation = RotationPrior{made.pose_true.R, 1e-4 * Eigen::Matrix3d::Identity()};
  rough.gravity->sd2_rad = 12.0 * kRadPerDeg;
  const MotionPrior* const priors[] = {nullptr, &no_gravity, &rough};
  for (const MotionPrior* motion : priors) {
    RandomStream rng({.seed = 1, .purpose = 4193}), same({.seed = 1, .purpose = 4193});
    HypothesisSearch after = before;
    AddUprightCandidates(matches, score_matches, {1e-3, true, motion}, 100, 4, rng, &after);
    ExpectSameCandidates(before, after);
    EXPECT_EQ(rng.Next64(), same.Next64());
  }
}

// With a measurement that has nothing to do with the motion, too: the others stay, in their order, and come
// first unless a new one is better.
TEST(UprightSearch, AddsEssentialMatricesAndRemovesNone) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    UprightProblem made = MakeUprightProblem(0.4, 1.0, trial);
    if (trial % 2 == 1) made.motion.gravity->in_cam2 = Eigen::Vector3d::UnitX();
    const auto [five, both] = SearchBoth(made, 400, trial);
    ASSERT_GT(both.candidates.size(), five.candidates.size());
    EXPECT_LE(both.candidates.size(), five.candidates.size() + 4);
    const size_t first = both.candidates[0].E == five.candidates[0].E ? 0 : 1;
    if (first == 1) {
      EXPECT_GT(both.candidates[0].score, five.candidates[0].score);
    }
    for (size_t i = 0; i < five.candidates.size(); ++i)
      EXPECT_EQ(both.candidates[i + first].E, five.candidates[i].E);
    for (const ScoredEssential& candidate : both.candidates) {
      const Eigen::Matrix3d& E = candidate.E;
      EXPECT_LE(candidate.score, both.candidates[0].score);
      EXPECT_NEAR((E * E.transpose() * E - E).norm(), 0.0, 1e-5);  // singular values 1, 1, 0
    }
  }
}

}  // namespace
}  // namespace rcme
