#include "estimator/model_choice/orb_slam2.h"

#include <gtest/gtest.h>

#include <limits>

namespace rcme {
namespace {

// Two cameras with K = diag(2, 2, 1) and sigma = 0.5 px: whitened coordinates are twice the pixels.
MotionProblem OneMatch(double shift_x_px, double shift_y_px) {
  const Camera camera{2.0, 2.0, 0.0, 0.0, 100, 100};
  return {{{Eigen::Vector2d(3.0, 1.0), Eigen::Vector2d(3.0 + shift_x_px, 1.0 + shift_y_px)}},
          camera,
          camera,
          0.5};
}

TEST(OrbSlam2, ScoresAreWhatTheFormulasGiveByHand) {
  const Eigen::Matrix3d H = Eigen::Matrix3d::Identity();  // transfers to the same pixel
  EXPECT_NEAR(OrbSlam2HomographyScore(OneMatch(0.0, 0.0), H), 2 * 5.99, 1e-12);
  EXPECT_NEAR(OrbSlam2HomographyScore(OneMatch(0.5, 0.0), H), 2 * (5.99 - 1.0), 1e-12);
  EXPECT_NEAR(OrbSlam2HomographyScore(OneMatch(0.0, 1.0), H), 2 * (5.99 - 4.0), 1e-12);
  EXPECT_NEAR(OrbSlam2HomographyScore(OneMatch(1.0, 1.0), H), 0.0, 1e-12);  // 8 > 5.99
  // Translation along x: epipolar lines are rows.
  Eigen::Matrix3d E;
  E << 0, 0, 0, 0, 0, -1, 0, 1, 0;
  EXPECT_NEAR(OrbSlam2EpipolarScore(OneMatch(7.0, 0.0), E), 2 * 5.99, 1e-12);
  EXPECT_NEAR(OrbSlam2EpipolarScore(OneMatch(7.0, 0.5), E), 2 * (5.99 - 1.0), 1e-12);
  EXPECT_NEAR(OrbSlam2EpipolarScore(OneMatch(0.0, 1.0), E), 0.0, 1e-12);  // 4 > 3.84
}

// Twice as large in image 2: a match one pixel off is so in image 2 and half as much in image 1.
TEST(OrbSlam2, EachImageHasADistanceOfItsOwn) {
  MotionProblem problem = OneMatch(0.0, 0.0);
  problem.matches[0].x2_px = 2.0 * problem.matches[0].x1_px + Eigen::Vector2d(0.5, 0.0);
  const Eigen::Matrix3d H = Eigen::Vector3d(2.0, 2.0, 1.0).asDiagonal();
  EXPECT_NEAR(OrbSlam2HomographyScore(problem, H), (5.99 - 1.0) + (5.99 - 0.25), 1e-12);
}

TEST(OrbSlam2, WhatIsNoNumberScoresNothing) {
  EXPECT_EQ(OrbSlam2HomographyScore(OneMatch(0.0, 0.0), Eigen::Matrix3d::Zero()), 0.0);
  EXPECT_EQ(OrbSlam2EpipolarScore(OneMatch(0.0, 0.0), Eigen::Matrix3d::Zero()), 0.0);
}

}  // namespace
}  // namespace rcme
