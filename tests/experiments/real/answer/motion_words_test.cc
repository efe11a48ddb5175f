#include "experiments/real/answer/motion_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "experiments/real/answer/refusal_advice.h"
#include "stats/constants.h"
#include "stats/random.h"

namespace rcme {
namespace {

// A camera that is turned to the right sees what was right of it nearer the middle: the words are held
// against where an object in front of camera 1 moves, not against another convention.
TEST(MotionWords, ATurnToTheRightMovesTheSceneToTheLeft) {
  const Eigen::Vector3d ahead(0.0, 0.0, 5.0);
  const auto R_of = [](const Eigen::Vector3d& w_deg) {
    return RotationFromVector(kRadPerDeg * w_deg).transpose().eval();  // cam2_from_cam1
  };
  const Eigen::Matrix3d right = R_of({0.0, 10.0, 0.0});
  EXPECT_LT((right * ahead).x(), 0.0);
  EXPECT_EQ(ComputeTurn(right).words, "10 deg to the right");
  const Eigen::Matrix3d up = R_of({10.0, 0.0, 0.0});
  EXPECT_GT((up * ahead).y(), 0.0) << "what was ahead is lower in the image";
  EXPECT_EQ(ComputeTurn(up).words, "10 deg up");
  const Eigen::Matrix3d clockwise = R_of({0.0, 0.0, 10.0});
  EXPECT_LT((clockwise * Eigen::Vector3d::UnitX()).y(), 0.0) << "the right of the scene goes up";
  EXPECT_EQ(ComputeTurn(clockwise).words, "10 deg clockwise");
  EXPECT_EQ(ComputeTurn(R_of({0.5, -8.0, -3.0})).words, "8 deg to the left, 3 deg anticlockwise");
  EXPECT_EQ(ComputeTurn(Eigen::Matrix3d::Identity()).angle_deg, 0.0);
}

TEST(MotionWords, ACameraThatMovesForwardStandsForward) {
  // X2 = R X1 + t: of a camera one ahead, what is five ahead is four away.
  const RelativePose forward{Eigen::Matrix3d::Identity(), {0.0, 0.0, -1.0}};
  EXPECT_EQ(DescribePlace(forward), "forward");
  const RelativePose turned{RotationFromVector({0.0, -1.2, 0.3}),
                            Eigen::Vector3d(-2.0, 0.1, 1.0).normalized()};
  const Eigen::Vector3d place = ComputePlace(turned);
  EXPECT_LT((turned.R * place + turned.t).norm(), 1e-12) << "camera 2 is its own origin";
}

// 95 % of draws from the covariance lie in the ellipsoids, the sd of the angle is that of drawn rotations.
TEST(MotionWords, RegionsHoldWhatTheySay) {
  const RelativePose pose{RotationFromVector({0.1, 0.4, -0.2}), Eigen::Vector3d(1.0, 0.5, 0.2).normalized()};
  Matrix5d root = Matrix5d::Zero();
  root.diagonal() << 2e-3, 1e-3, 5e-4, 8e-3, 2e-3;
  root(1, 0) = 1e-3;
  root(4, 3) = 3e-3;
  const Matrix5d cov = root * root.transpose();
  const MotionSpread spread = ComputeSpread(pose, cov);
  RandomStream rng({.seed = 1, .purpose = 5});
  constexpr int kDraws = 20000;
  int num_rotations = 0, num_directions = 0;
  double sum_squares = 0.0;
  const double angle_deg = ComputeTurn(pose.R).angle_deg;
  for (int i = 0; i < kDraws; ++i) {
    Vector5d z;
    for (double& x : z) x = rng.Normal();
    const Vector5d p = root * z;
    const Eigen::Vector3d w = p.head<3>();
    const Eigen::Vector2d b = p.tail<2>();
    num_rotations += w.dot(cov.topLeftCorner<3, 3>().inverse() * w) < 7.8147;
    num_directions += b.dot(cov.bottomRightCorner<2, 2>().inverse() * b) < 5.9915;
    sum_squares += std::pow(ComputeTurn(Retract(pose, p).R).angle_deg - angle_deg, 2);
  }
  // Binomial sd 0.0015.
  EXPECT_NEAR(1.0 * num_rotations / kDraws, 0.95, 0.006);
  EXPECT_NEAR(1.0 * num_directions / kDraws, 0.95, 0.006);
  EXPECT_NEAR(std::sqrt(sum_squares / kDraws) / spread.angle_sd_deg, 1.0, 0.03);
  // The semi-axes are those of these ellipsoids: their product is det^(1/2) chi2^(k/2).
  const double deg3 = std::pow(1.0 / kRadPerDeg, 3);
  EXPECT_NEAR(spread.rotation_95_deg.prod(),
              deg3 * std::sqrt(cov.topLeftCorner<3, 3>().determinant()) * std::pow(7.8147, 1.5), 1e-4);
  EXPECT_NEAR(spread.direction_95_deg(0) / spread.direction_sd_deg(0), std::sqrt(5.9915), 1e-3);
  EXPECT_GE(spread.direction_sd_deg(0), spread.direction_sd_deg(1));
}

// Every refusal has advice, and options it names are those of the estimator.
TEST(RefusalAdvice, NamesWhatTheEstimatorHas) {
  for (const MotionStatus status : AllStatuses()) {
    MotionEstimate estimate;
    estimate.status = status;
    for (const char* name : {"rcme", "rcme_calibrated", "standard"}) {
      const bool has_none = status == MotionStatus::kOk || status == MotionStatus::kNotSimulated ||
                            status == MotionStatus::kTruthInDoubt;
      EXPECT_EQ(AdviceFor(estimate, DefaultEstimator(name)).empty(), has_none) << StatusName(status);
    }
  }
  MotionEstimate none;
  none.status = MotionStatus::kNoCandidate;
  EXPECT_THAT(AdviceFor(none, DefaultEstimator("rcme")),
              testing::Contains(testing::HasSubstr("num_iterations=2000")));
  EXPECT_THAT(AdviceFor(none, DefaultEstimator("rcme_calibrated")),
              testing::Not(testing::Contains(testing::HasSubstr("rcme_calibrated"))));
}

// A mode 0.05 standard deviations away is the answer once more; one that is 0.2 away, in either part, is not.
TEST(RunnerUp, IsAnotherMotionThanTheAnswer) {
  MotionEstimate estimate;
  estimate.cam2_from_cam1.t = Eigen::Vector3d::UnitX();
  estimate.pose_cov = 1e-4 * Matrix5d::Identity();  // 0.0173 rad of rotation, 0.0141 of direction
  EXPECT_EQ(FindRunnerUp(estimate), nullptr);
  const auto add = [&](double turn, double swing) {
    MotionMode mode;
    mode.cam2_from_cam1.R = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()).toRotationMatrix();
    mode.cam2_from_cam1.t = Eigen::Vector3d(std::cos(swing), std::sin(swing), 0.0);
    estimate.other_modes.push_back(mode);
  };
  add(0.05 * 0.0173, 0.05 * 0.0141);
  EXPECT_EQ(FindRunnerUp(estimate), nullptr);
  add(0.0, 0.2 * 0.0141);
  EXPECT_EQ(FindRunnerUp(estimate), &estimate.other_modes[1]);
  estimate.other_modes.clear();
  add(0.2 * 0.0173, 0.0);
  EXPECT_EQ(FindRunnerUp(estimate), &estimate.other_modes[0]);
}

}  // namespace
}  // namespace rcme
