#include "estimator/calibrated/settle_direction.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "stats/constants.h"
#include "tests/test_support/calibrated_mode.h"
#include "tests/test_support/street_scenes.h"

namespace rcme {
namespace {

constexpr double kBound = RadFromDeg(15.0);

// Points from `near` to twice as many baselines away, noise 0.5 px; the answer is the fit from `start`.
struct FarCase {
  RandomProblem random;
  FittedMode fitted;
  ExplainedMode answer;
};
FarCase MakeFar(std::uint32_t trial, double near, bool starts_at_truth) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2797});
  RandomProblem random =
      MakeRandomProblem(rng, {.num_matches = 200, .min_depth = near, .max_depth = 2.0 * near});
  AddNoise(0.5, rng, &random.problem);
  RelativePose start = random.pose_true;
  if (!starts_at_truth) start.t = start.t.unitOrthogonal();
  FittedMode fitted = FitFromTruth(random.problem, start);
  ExplainedMode answer{fitted.mode, Explain(fitted.matches, fitted.mode)};
  return {random, fitted, answer};
}

TEST(SettleDirection, LeavesAClearParallaxAlone) {
  FarCase far = MakeFar(0, 5.0, true);
  EXPECT_FALSE(SettleDirection(far.random.problem, far.fitted.matches, far.fitted.prior, kBound,
                               CalibratedStep::kNone, &far.answer));
}

// 200 baselines away the parallax is some pixels' noise: a fit that began across the true direction ends at
// it or states that it is lost.
TEST(SettleDirection, MovesAWrongAnswerOrDoubtsIt) {
  int num_low = 0, num_right = 0, num_sure_and_wrong = 0;
  constexpr int kTrials = 30;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    FarCase far = MakeFar(trial, 200.0, false);
    const auto direction = SettleDirection(far.random.problem, far.fitted.matches, far.fitted.prior, kBound,
                                           CalibratedStep::kNone, &far.answer);
    if (!direction) continue;
    ++num_low;
    EXPECT_GE(direction->mass_within, 0.0);
    EXPECT_LE(direction->mass_within, 1.0 + 1e-12);
    const bool is_right = AngleBetween(far.answer.mode.pose.t, far.random.pose_true.t) <= kBound;
    num_right += is_right;
    num_sure_and_wrong += !is_right && direction->mass_within > 0.9;
  }
  EXPECT_GE(num_low, kTrials * 2 / 3);
  EXPECT_GE(num_right, num_low / 2);
  EXPECT_LE(num_sure_and_wrong, 2);
}

// What is stated is never less than the mass about the first answer. An answer moves only where that mass
// grows. If it stays against the law, the odds of the modes, above one, give it at least half of the mass
// near either direction.
TEST(SettleDirection, MovesToMoreMassAlone) {
  int num_moved = 0, num_stayed = 0, num_kept = 0;
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    FarCase far = MakeFar(trial, 400.0, true);
    const RelativePose before = far.answer.mode.pose;
    const DirectionPosterior at_first =
        PosteriorOfDirection(far.random.problem, far.answer, before.t, kBound);
    const auto direction = SettleDirection(far.random.problem, far.fitted.matches, far.fitted.prior, kBound,
                                           CalibratedStep::kNone, &far.answer);
    if (!direction) continue;
    const bool has_moved = far.answer.mode.pose.t != before.t;
    EXPECT_GE(direction->mass_within, at_first.mass_within) << trial;
    if (!has_moved && direction->mass_within > at_first.mass_within) {
      EXPECT_GE(direction->mass_within, 0.5 * at_first.mass_of_both) << trial;
      EXPECT_LE(direction->mass_within, at_first.mass_of_both) << trial;
      ++num_kept;
    }
    if (has_moved) {
      EXPECT_GT(direction->mass_within, at_first.mass_within) << trial;
    }
    (has_moved ? num_moved : num_stayed) += 1;
  }
  EXPECT_GE(num_moved, 3);
  EXPECT_GE(num_stayed, 3);
  EXPECT_GE(num_kept, 1);
}

// With depths independent of the place in the image the law would exclude the true direction in 39 of 40.
TEST(SettleDirection, AStreetIsNotTakenForItsTwin) {
  const StreetScenes street_scenes;
  constexpr int kTrials = 40;
  int num_weak = 0, num_excluded = 0, num_moved_away = 0;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    const StreetScenes::Case street = street_scenes.Make(trial);
    const FittedMode fitted = FitFromTruth(street.problem, street.pose_true);
    ExplainedMode answer{fitted.mode, Explain(fitted.matches, fitted.mode)};
    if (AngleBetween(answer.mode.pose.t, street.pose_true.t) > kBound) continue;
    const double mass = PosteriorOfDirection(street.problem, answer, street.pose_true.t, kBound).mass_within;
    const auto direction =
        SettleDirection(street.problem, fitted.matches, fitted.prior, kBound, CalibratedStep::kNone, &answer);
    if (!direction) continue;
    ++num_weak;
    num_excluded += mass < 0.01;
    num_moved_away += AngleBetween(answer.mode.pose.t, street.pose_true.t) > kBound;
  }
  EXPECT_GE(num_weak, kTrials * 3 / 4);
  EXPECT_LE(num_excluded, kTrials / 8);
  EXPECT_LE(num_moved_away, kTrials / 8);
}

}  // namespace
}  // namespace rcme
