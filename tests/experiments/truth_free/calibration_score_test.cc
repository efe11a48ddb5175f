#include "experiments/truth_free/calibration_score.h"

#include <gtest/gtest.h>

#include "tests/test_support/fit_of.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// An inlier counts by its probability: of 0 as if it were none, of a half by half.
TEST(ScoreCalibration, WeighsInliersByTheirProbability) {
  RelativePose pose;
  const MotionProblem problem = TwoCameraProblem(60, 0.5, 0.0, 1, &pose);
  MotionEstimate all = FitOf(problem, pose);
  all.sigma_estimated_px = 0.5;
  MotionEstimate some = all, by_probability = all;
  some.inliers.resize(40);
  for (size_t i = 0; i < 60; ++i) by_probability.inlier_probabilities.push_back(i < 40 ? 1.0 : 0.0);
  const CalibrationScore expected = *ScoreCalibration(problem, some);
  const CalibrationScore found = *ScoreCalibration(problem, by_probability);
  EXPECT_LT((found.score - expected.score).norm(), 1e-9 * expected.score.norm());
  EXPECT_LT((found.information - expected.information).norm(), 1e-9 * expected.information.norm());
  const CalibrationScore whole = *ScoreCalibration(problem, all);
  MotionEstimate halves = all;
  halves.inlier_probabilities.assign(60, 0.5);
  const CalibrationScore half = *ScoreCalibration(problem, halves);
  EXPECT_LT((half.score - 0.5 * whole.score).norm(), 1e-9 * whole.score.norm());
  EXPECT_LT((half.information - 0.5 * whole.information).norm(), 1e-9 * whole.information.norm());
}

// Over the square of the noise, that of the pair and that of the match.
TEST(ScoreCalibration, WeighsInliersByTheirNoise) {
  RelativePose pose;
  MotionProblem problem = TwoCameraProblem(60, 0.5, 0.0, 1, &pose);
  MotionEstimate estimate = FitOf(problem, pose);
  estimate.sigma_estimated_px = 0.5;
  const CalibrationScore once = *ScoreCalibration(problem, estimate);
  estimate.sigma_estimated_px = 1.5;
  const CalibrationScore thrice = *ScoreCalibration(problem, estimate);
  EXPECT_LT((9.0 * thrice.information - once.information).norm(), 1e-9 * once.information.norm());
  problem.noise_scale.assign(60, 2.0);
  const CalibrationScore scaled = *ScoreCalibration(problem, estimate);
  EXPECT_LT((36.0 * scaled.score - once.score).norm(), 1e-9 * once.score.norm());
}

TEST(ScoreCalibration, NeedsTwentyInliers) {
  RelativePose pose;
  const MotionProblem problem = TwoCameraProblem(60, 0.5, 0.0, 1, &pose);
  MotionEstimate estimate = FitOf(problem, pose);
  estimate.inliers.resize(20);
  EXPECT_TRUE(ScoreCalibration(problem, estimate).has_value());
  estimate.inliers.resize(19);
  EXPECT_FALSE(ScoreCalibration(problem, estimate).has_value());
}

}  // namespace
}  // namespace rcme
