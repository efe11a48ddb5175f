#include "experiments/rare/failing_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/study/study_file.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

StudyPlan MakeScenePlan(const std::string& scene) {
  return MakePlan(ParseStudy("name: moves\nseed: 5\ntrials: 10\ndata: {scene: " + scene +
                                 ", num_matches: 25, outlier_ratio: 0.1, sigma_px: 0.5, severity: skipped}\n"
                                 "estimators:\n  - {name: standard, options: {num_iterations: 5}}\n",
                             "moves.yaml"));
}

TEST(FailingMotion, DrawsFourNumbersForEachPoint) {
  const StudyPlan plan = MakeScenePlan("uniform_volume");
  RandomStream rng({.seed = 1, .purpose = 77});
  const MotionInputs state = FailingMotion(plan, plan.conditions[0], 0).Draw(rng);
  EXPECT_EQ(state.noise.size(), 4 * state.scene->points_in_cam1.size());
}

// A move of the noise by `step` keeps it normal: z' = sqrt(1 - step^2) z + step n, so that of 100 moves of
// 100 numbers the mean square of z' stays that of z, and its product with z is sqrt(1 - step^2) of it
// (z-tests at 1e-4).
TEST(FailingMotion, MovesOfTheNoiseKeepItsLaw) {
  const StudyPlan plan =
      MakeScenePlan("plane_and_parallax");  // points are not free: local moves are of the noise
  const FailingMotion system(plan, plan.conditions[0], 0);
  RandomStream rng({.seed = 1, .purpose = 78});
  for (const double step : {0.3, 0.8}) {
    double sum_squares = 0.0, sum_products = 0.0, sum_before = 0.0, n = 0.0;
    for (int i = 0; i < 200; ++i) {
      const MotionInputs state = system.Draw(rng);
      bool is_local = false;
      const MotionInputs moved = system.Propose(state, step, rng, is_local);
      if (!is_local) continue;
      ASSERT_EQ(moved.scene, state.scene);
      for (size_t k = 0; k < moved.noise.size(); ++k) {
        sum_squares += moved.noise[k] * moved.noise[k];
        sum_products += moved.noise[k] * state.noise[k];
        sum_before += state.noise[k] * state.noise[k];
        n += 1.0;
      }
    }
    EXPECT_NEAR(sum_squares / n, 1.0, 3.89 * std::sqrt(2.0 / n));
    EXPECT_NEAR(sum_products / sum_before, std::sqrt(1.0 - step * step), 3.89 * step / std::sqrt(n));
  }
}

// An answer within the bounds is at most at the bound, whatever the rounding; one beyond is beyond.
TEST(ErrorOverBound, IsAtMostOneForAGoodAnswer) {
  TrialRecord record;
  record.status = MotionStatus::kOk;
  record.rotation_error_deg = 0.0;
  record.direction_error_deg = 0.0;
  // 0 / 0 where no error is allowed, and there is none.
  EXPECT_EQ(ErrorOverBound(record, {0.0, 0.0}), 1.0);
  EXPECT_EQ(ErrorOverBound(record, {0.0, 15.0}), 1.0);
  record.rotation_error_deg = 1e-300;
  EXPECT_GT(ErrorOverBound(record, {0.0, 1.0}), 1.0);
  // A direction that is not known fails nobody.
  record.rotation_error_deg = 1.0;
  record.direction_error_deg = std::nan("");
  EXPECT_EQ(ErrorOverBound(record, {1.0, 1.0}), 1.0);
  EXPECT_EQ(ErrorOverBound(record, {4.0, 1.0}), 0.25);
}

TEST(FailingMotion, RefusesPairsOfFiles) {
  Study study = ParseStudy(
      "name: real\nseed: 1\ntrials: 1\ndata: {scene: match_files, folder: nowhere}\n"
      "estimators: [{name: standard}]\n",
      "real.yaml");
  EXPECT_TRUE(ThrowsInputError([&] { RequireDrawnScenes(study); }, {"match_files", "not allowed"}));
}

}  // namespace
}  // namespace rcme
