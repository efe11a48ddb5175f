#include "experiments/real/answer/calibration_effect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "estimator/refinement/sampson_mle.h"
#include "stats/constants.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

// Matches without noise, and the true motion as the answer that explains them all.
struct ExactAnswer {
  MotionProblem problem;
  MotionEstimate estimate;
};

ExactAnswer MakeExactAnswer(int num_matches, std::uint32_t trial, bool has_one_camera) {
  RandomStream rng({.seed = 5, .trial = trial, .purpose = 460});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = num_matches});
  if (has_one_camera) {
    MotionProblem& problem = random.problem;
    for (Correspondence& match : problem.matches)
      match.x2_px = problem.camera1.Project(problem.camera2.Ray(match.x2_px));
    problem.camera2 = problem.camera1;
  }
  ExactAnswer made{random.problem, {}};
  made.estimate.status = MotionStatus::kOk;
  made.estimate.cam2_from_cam1 = random.pose_true;
  made.estimate.inliers.resize(made.problem.matches.size());
  std::iota(made.estimate.inliers.begin(), made.estimate.inliers.end(), 0);
  return made;
}

// Squared angles by which the fit moves if the cameras are changed, rad^2.
struct Moves {
  double rotation = 0.0, direction = 0.0;
};

template <typename Change>
void AddMoves(const ExactAnswer& answered, const Change& change, Moves* sum) {
  MotionProblem changed = answered.problem;
  change(changed);
  const RefinedMotion fit = RefineAllBySampson(changed, answered.estimate.cam2_from_cam1);
  ASSERT_TRUE(fit.converged);
  const Vector5d move = LocalCoordinates(answered.estimate.cam2_from_cam1, fit.cam2_from_cam1);
  sum->rotation += move.head<3>().squaredNorm();
  sum->direction += move.tail<2>().squaredNorm();
}

// To first order: the intrinsics are changed by a hundredth of the effect's standard deviation.
void ExpectEffect(const CalibrationEffect& effect, const Moves& moves) {
  const double rotation_deg = 100.0 * kDegPerRad * std::sqrt(moves.rotation),
               direction_deg = 100.0 * kDegPerRad * std::sqrt(moves.direction);
  EXPECT_NEAR(effect.rotation_rms_deg / rotation_deg, 1.0, 0.1) << effect.error;
  EXPECT_NEAR(effect.direction_rms_deg / direction_deg, 1.0, 0.1) << effect.error;
}

void ScaleFocal(Camera& camera) { camera.fx *= 1.0001, camera.fy *= 1.0001; }

TEST(CalibrationEffect, IsHowFarFitsWithOtherIntrinsicsMove) {
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    const ExactAnswer answered = MakeExactAnswer(100, trial, false);
    const std::vector<CalibrationEffect> effects =
        ComputeCalibrationEffects(answered.problem, answered.estimate);
    ASSERT_EQ(effects.size(), 3u);
    Moves focal, principal_point;
    for (Camera MotionProblem::*camera : {&MotionProblem::camera1, &MotionProblem::camera2}) {
      AddMoves(
          answered, [&](MotionProblem& p) { ScaleFocal(p.*camera); }, &focal);
      for (double Camera::*coordinate : {&Camera::cx, &Camera::cy})
        AddMoves(
            answered, [&](MotionProblem& p) { (p.*camera).*coordinate += 0.05; }, &principal_point);
    }
    ExpectEffect(effects[0], focal);
    ExpectEffect(effects[1], principal_point);
  }
}

// Both images have the same error.
TEST(CalibrationEffect, OfOneCameraIsOfTheSameErrorInBothImages) {
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    const ExactAnswer answered = MakeExactAnswer(100, trial, true);
    const std::vector<CalibrationEffect> effects =
        ComputeCalibrationEffects(answered.problem, answered.estimate);
    ASSERT_EQ(effects.size(), 3u);
    Moves focal;
    AddMoves(
        answered, [](MotionProblem& p) { ScaleFocal(p.camera1), ScaleFocal(p.camera2); }, &focal);
    ExpectEffect(effects[0], focal);
  }
}

TEST(CalibrationEffect, IsBoundedOrEmptyWithoutEnoughMatches) {
  EXPECT_TRUE(ComputeCalibrationEffects({}, {}).empty());
  ExactAnswer answered = MakeExactAnswer(20, 0, false);
  answered.estimate.inliers = {0, 1, 2, 3};
  for (const CalibrationEffect& effect : ComputeCalibrationEffects(answered.problem, answered.estimate)) {
    EXPECT_LE(effect.rotation_rms_deg, 180.0);
    EXPECT_LE(effect.direction_rms_deg, 180.0);
  }
}

TEST(CalibrationEffect, OptionsStateErrors) {
  EstimatorSpec spec = DefaultEstimator("rcme_calibrated");
  EXPECT_FALSE(StatesCalibrationErrors(spec));
  SetOptions(&spec, {{"distortion_sd", "0.01"}});
  EXPECT_TRUE(StatesCalibrationErrors(spec));
  EstimatorSpec standard = DefaultEstimator("standard");  // its own covariance knows no such error
  SetOptions(&standard, {{"focal_sd", "0.01"}});
  EXPECT_FALSE(StatesCalibrationErrors(standard));
  SetOptions(&standard, {{"covariance", "robust"}});
  EXPECT_TRUE(StatesCalibrationErrors(standard));
}

}  // namespace
}  // namespace rcme
