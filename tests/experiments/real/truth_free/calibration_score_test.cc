#include "experiments/real/truth_free/calibration_score.h"

#include <gtest/gtest.h>

#include "estimator/geometry/sampson.h"
#include "experiments/real/truth_free/twin.h"
#include "tests/test_support/fit_all_matches.h"
#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// An inlier counts by its probability: of 0 as if it were none, of a half by half.
TEST(ScoreCalibration, WeighsInliersByTheirProbability) {
  RelativePose pose;
  const MotionProblem problem = TwoCameraProblem(60, 0.5, 0.0, 1, &pose);
  MotionEstimate all = FitAllMatches(problem, pose);
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
  MotionEstimate estimate = FitAllMatches(problem, pose);
  estimate.sigma_estimated_px = 0.5;
  const CalibrationScore once = *ScoreCalibration(problem, estimate);
  estimate.sigma_estimated_px = 1.5;
  const CalibrationScore thrice = *ScoreCalibration(problem, estimate);
  EXPECT_LT((9.0 * thrice.information - once.information).norm(), 1e-9 * once.information.norm());
  problem.noise_scale.assign(60, 2.0);
  const CalibrationScore scaled = *ScoreCalibration(problem, estimate);
  EXPECT_LT((36.0 * scaled.score - once.score).norm(), 1e-9 * once.score.norm());
}

// The score is freed of the motion: of exact matches at a motion that is off by e along every coordinate the
// residuals are those of the motion, J e, which it does not go with. What is left is of second order: a tenth
// of the error leaves a hundredth. Without that it would go as the error, and leave a tenth.
TEST(ScoreCalibration, DoesNotGoWithAnErrorOfTheMotion) {
  RelativePose pose;
  MotionProblem problem = TwoCameraProblem(60, 0.0, 0.0, 1, &pose);
  problem.sigma_px = 0.5;
  MotionEstimate estimate = FitAllMatches(problem, pose);
  estimate.sigma_estimated_px = 0.5;
  const auto size_at = [&](double error) {
    estimate.cam2_from_cam1 = Retract(pose, Vector5d::Constant(error));
    return ScoreCalibration(problem, estimate)->score.norm();
  };
  EXPECT_GT(size_at(1e-3), 0.0);
  EXPECT_LT(size_at(1e-4), 0.02 * size_at(1e-3));
}

TEST(ScoreCalibration, NeedsTwentyInliers) {
  RelativePose pose;
  const MotionProblem problem = TwoCameraProblem(60, 0.5, 0.0, 1, &pose);
  MotionEstimate estimate = FitAllMatches(problem, pose);
  estimate.inliers.resize(20);
  EXPECT_TRUE(ScoreCalibration(problem, estimate).has_value());
  estimate.inliers.resize(19);
  EXPECT_FALSE(ScoreCalibration(problem, estimate).has_value());
}

// D = r_X d - r u' d_X u, r_X and d_X u by differences of r and of d, of matches that are off their epipolar
// lines by about a pixel: the second part is some thousandths of the first.
TEST(ResidualByFaults, IsThatOfTheHeader) {
  RelativePose pose;
  const MotionProblem problem = TwoCameraProblem(6, 1.0, 0.0, 1, &pose);
  const Eigen::Matrix3d F = ComputeFundamental(problem, pose);
  for (const Correspondence& match : problem.matches) {
    const auto moved_by = [&](const Eigen::Vector4d& x) {
      return Correspondence{match.x1_px + x.head<2>(), match.x2_px + x.tail<2>()};
    };
    const auto residual_at = [&](const Eigen::VectorXd& x) {
      const EpipolarConstraint c = EvaluateConstraint(F, moved_by(x));
      return Eigen::VectorXd::Constant(1, c.g / std::sqrt(c.squared_gradient())).eval();
    };
    const Eigen::Vector4d u = EvaluateConstraint(F, match).gradient.normalized();
    const auto shifts_at = [&](const Eigen::VectorXd& along) -> Eigen::VectorXd {
      const ShiftsByFaults shifts =
          ComputeShifts(problem.camera1, problem.camera2, pose, moved_by(along(0) * u));
      return shifts.transpose() * u;
    };
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(4);
    const double r = residual_at(none)(0);
    const Eigen::MatrixXd r_X = NumericJacobian(residual_at, none, 0.1);
    const Eigen::MatrixXd u_d_X_u = NumericJacobian(shifts_at, Eigen::VectorXd(none.head(1)), 0.1);
    const Eigen::MatrixXd expected =
        r_X * ComputeShifts(problem.camera1, problem.camera2, pose, match) - r * u_d_X_u.transpose();
    EXPECT_JACOBIAN_NEAR(ResidualByFaults(F, problem.camera1, problem.camera2, pose, match), expected, 1e-6);
  }
}

}  // namespace
}  // namespace rcme
