// Modes made by hand, so that every weight is known in closed form.
#include "estimator/calibrated/weigh_modes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/calibrated/fitted_constants.h"
#include "estimator/calibrated/mode_weights.h"

namespace rcme {
namespace {

constexpr double kDensity = 1e-2;                   // of a wrong match
constexpr MotionBounds kModeBounds = {0.05, 0.25};  // rad
const MixturePrior kPrior = {kDensity, true};

// A motion along the optical axis that turns by so much about it; ten matches of 19 times the density of a
// wrong one, which are evidence of 10 log 10 nats.
ExplainedMode ModeAt(double turn_rad, int num_explained = 100, double scale = 1.0) {
  ExplainedMode made;
  made.mode.pose = {RotationFromVector({0.0, 0.0, turn_rad}), Eigen::Vector3d::UnitZ()};
  made.mode.hessian = Matrix5d::Identity() / (scale * scale);
  made.mode.mixture.scale = scale;
  made.mode.mixture.inlier_ratio = 0.5;
  made.mode.mixture.outlier_density = kDensity;
  made.explanation.left_out_density.assign(10, 19.0 * kDensity);
  made.explanation.probability.assign(10, 0.9);
  made.explanation.terms.depth.assign(10, 0.0);
  made.explanation.num_explained = num_explained;
  return made;
}
const double kNone = std::exp(-(10.0 * std::log(10.0) - kSearchNats));  // odds of no motion against that

TEST(WeighModes, OneModeIsWeighedAgainstNone) {
  const ModeWeights weights = WeighModes({ModeAt(0.0)}, kModeBounds, kPrior, {});
  EXPECT_EQ(weights.answer, 0u);
  EXPECT_NEAR(weights.of_no_motion, kNone / (1.0 + kNone), 1e-12);
  EXPECT_NEAR(weights.of_modes[0], 1.0 / (1.0 + kNone), 1e-12);
  EXPECT_FALSE(weights.is_rival[0]);
  EXPECT_FALSE(weights.is_second_motion[0]);
}

TEST(WeighModes, TheGreaterOfTwoDensitiesOfWrongMatchesCounts) {
  ExplainedMode mode = ModeAt(0.0);
  EXPECT_NEAR(WeighModes({mode}, kModeBounds, {1e-4, true}, {}).of_no_motion, kNone / (1.0 + kNone), 1e-12);
  mode.mode.mixture.outlier_density = 1e-4;
  EXPECT_NEAR(WeighModes({mode}, kModeBounds, kPrior, {}).of_no_motion, kNone / (1.0 + kNone), 1e-12);
}

// Evidence against any motion, of 22 nats, counts as two.
TEST(WeighModes, NoMotionIsNeverMoreThanSevenTimesAsLikely) {
  ExplainedMode mode = ModeAt(0.0);
  mode.explanation.left_out_density.assign(10, kDensity);
  const ModeWeights weights = WeighModes({mode}, kModeBounds, kPrior, {});
  EXPECT_NEAR(weights.of_no_motion / weights.of_modes[0], std::exp(2.0), 1e-9);
}

// 0.5 standard deviations away is the same motion, 2 are another.
TEST(WithoutCopies, AddsTheWeightOfACopyToTheAnswer) {
  ModeWeights weights;
  weights.answer = 1;
  weights.of_modes = {0.2, 0.5, 0.1};
  const std::vector<ExplainedMode> modes = {ModeAt(0.5), ModeAt(0.0), ModeAt(2.0)};
  const ModeWeights merged = WithoutCopies(modes, weights);
  EXPECT_EQ(merged.of_modes, (std::vector<double>{0.0, 0.7, 0.1}));
}

// The same motion found three times weighs as much as found once.
TEST(WeighModes, ModesWithinTheBoundsAreOne) {
  CalibratedOptions options;
  options.leave_out = CalibratedStep::kUsualMotions;
  const ModeWeights weights =
      WeighModes({ModeAt(0.0), ModeAt(0.01), ModeAt(0.04)}, kModeBounds, kPrior, options);
  EXPECT_NEAR(weights.of_no_motion, kNone / (1.0 + kNone), 1e-12);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_FALSE(weights.is_rival[i]);
    EXPECT_NEAR(weights.of_modes[i], 1.0 / 3.0 / (1.0 + kNone), 1e-12);
  }
}

// The odds of rivals against the answer, from their rotation, the number of matches and the noise, add up to
// the root of their powers.
TEST(WeighModes, RivalsAddUpToTheirNorm) {
  const std::vector<ExplainedMode> modes = {ModeAt(0.0), ModeAt(0.2, 90, 2.0), ModeAt(0.4, 80, 1.5)};
  const ModeWeights weights = WeighModes(modes, kModeBounds, kPrior, {});
  EXPECT_EQ(weights.answer, 0u);
  const auto odds = [](double turn_rad, int num_explained, double scale) {
    return std::exp(-ModeLogOdds({}, {100, 1.0, 0.0, 1.0, 0.0}, {num_explained, scale, 0.0, 1.0, turn_rad}));
  };
  const double first = odds(0.2, 90, 2.0), second = odds(0.4, 80, 1.5);
  const double norm = std::pow(std::pow(first, 2.5) + std::pow(second, 2.5), 0.4);
  const double total = 1.0 + norm + kNone;
  EXPECT_NEAR(weights.of_modes[0], 1.0 / total, 1e-12);
  EXPECT_NEAR(weights.of_modes[1], norm * first / (first + second) / total, 1e-12);
  EXPECT_NEAR(weights.of_modes[2], norm * second / (first + second) / total, 1e-12);
  EXPECT_NEAR(weights.of_no_motion, kNone / total, 1e-12);
  EXPECT_EQ(weights.is_rival, (std::vector<bool>{false, true, true}));
}

TEST(WeighModes, TheAnswerIsTheModeThatNoOtherBeats) {
  const std::vector<ExplainedMode> modes = {ModeAt(0.0, 70), ModeAt(0.2, 80), ModeAt(0.4, 100),
                                            ModeAt(0.6, 90)};
  CalibratedOptions options;
  options.leave_out = CalibratedStep::kUsualMotions;
  const ModeWeights weights = WeighModes(modes, kModeBounds, kPrior, options);
  EXPECT_EQ(weights.answer, 2u);
  EXPECT_GT(weights.of_modes[2], weights.of_modes[3]);
  EXPECT_GT(weights.of_modes[3], weights.of_modes[1]);
  EXPECT_GT(weights.of_modes[1], weights.of_modes[0]);
}

// Two modes with the same matches: the prior prefers the one that turns less, and does not if it is left out.
TEST(WeighModes, ThePriorOfTheMotionCanBeLeftOut) {
  const std::vector<ExplainedMode> modes = {ModeAt(0.0), ModeAt(0.2)};
  CalibratedOptions options;
  const ModeWeights with = WeighModes(modes, kModeBounds, kPrior, options);
  EXPECT_NEAR(with.of_modes[0] / with.of_modes[1],
              std::exp(ModeLogOdds({}, {100, 1.0, 0.0, 1.0, 0.0}, {100, 1.0, 0.0, 1.0, 0.2})), 1e-9);
  EXPECT_GT(with.of_modes[0], 2.0 * with.of_modes[1]);
  options.leave_out = CalibratedStep::kUsualMotions;
  const ModeWeights without = WeighModes(modes, kModeBounds, kPrior, options);
  EXPECT_NEAR(without.of_modes[0], without.of_modes[1], 1e-12);
}

// Two motions of their own, 20 matches against 15: the prior odds of the options times (15 / 20)^b.
TEST(WeighModes, ASecondMotionHasThePriorOfTheOptions) {
  ExplainedMode first = ModeAt(0.0), second = ModeAt(0.2);
  for (ExplainedMode* mode : {&first, &second}) {
    mode->explanation.left_out_density.assign(35, 1e-6);
    mode->explanation.probability.assign(35, 0.1);
    mode->explanation.terms.depth.assign(35, 0.0);
  }
  for (size_t i = 0; i < 35; ++i) {
    ExplainedMode& of = i < 20 ? first : second;
    of.explanation.left_out_density[i] = 1e3;
    of.explanation.probability[i] = 0.9;
  }
  for (const double odds : {0.6, 0.1}) {
    CalibratedOptions options;
    options.second_motion_odds = odds;
    for (const bool is_turned : {false, true}) {
      const ModeWeights weights = is_turned ? WeighModes({second, first}, kModeBounds, kPrior, options)
                                            : WeighModes({first, second}, kModeBounds, kPrior, options);
      const size_t other = 1 - weights.answer;
      EXPECT_EQ(weights.answer, is_turned ? 1u : 0u);
      EXPECT_TRUE(weights.is_second_motion[other]);
      EXPECT_FALSE(weights.is_second_motion[weights.answer]);
      EXPECT_NEAR(weights.of_modes[other] / weights.of_modes[weights.answer],
                  odds * std::pow(0.75, kSecondMotionTerms[0].weight), 1e-9);
    }
  }
}

// As WeighModes has them, until the answer moves.
TEST(FindRivals, AreOfWhereTheAnswerIsNow) {
  std::vector<ExplainedMode> modes = {ModeAt(0.0), ModeAt(0.04), ModeAt(0.2)};
  const ModeWeights weights = WeighModes(modes, kModeBounds, kPrior, {});
  EXPECT_EQ(FindRivals(modes, weights.answer, kModeBounds), weights.is_rival);
  modes[0].mode.pose = ModeAt(0.18).mode.pose;
  EXPECT_EQ(FindRivals(modes, 0, kModeBounds), (std::vector<bool>{false, true, false}));
}

TEST(ListModePairs, HasEveryTwoModesOnceWithTheirTerms) {
  std::vector<ExplainedMode> modes = {ModeAt(0.0), ModeAt(0.2, 90, 2.0), ModeAt(0.4, 80, 1.5)};
  modes[2].mode.hessian *= 2.0;
  const std::vector<ModePair> pairs = ListModePairs(modes);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[1].a, 0u);
  EXPECT_EQ(pairs[1].b, 2u);
  EXPECT_FALSE(pairs[1].is_second_motion);
  const auto expected =
      ComputeModeTerms({}, {100, 1.0, 0.0, 1.0, 0.0}, {80, 1.5, 5.0 * std::log(2.0), 1.0, 0.4});
  for (size_t k = 0; k < kNumModeTerms; ++k) EXPECT_NEAR(pairs[1].terms[k], expected[k], 1e-12) << k;
}

}  // namespace
}  // namespace rcme
