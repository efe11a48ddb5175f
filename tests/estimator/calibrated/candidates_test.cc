#include "estimator/calibrated/candidates.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "estimator/geometry/essential_matrix.h"
#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

TEST(PoseInFront, IsTheTruePoseOfTheTrueE) {
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    RelativePose pose_true;
    const MotionProblem problem = TwoCameraProblem(100, 0.5, 0.3, trial, &pose_true);
    for (const double sign : {1.0, -1.0}) {
      const RelativePose pose = PoseInFront(MatchBlocks(problem), sign * EssentialFromPose(pose_true));
      EXPECT_LT(LocalCoordinates(pose_true, pose).norm(), 1e-6) << trial;
    }
  }
}

TEST(IsSameMode, CountsStandardDeviationsOfTheFirst) {
  const FittedMode f = FitScene(100, 0.5, 0.2, 1);
  const Matrix5d root = f.mode.inverse_hessian.llt().matrixL();
  for (int k = 0; k < 5; ++k) {
    Mode beside = f.mode;
    beside.pose = Retract(f.mode.pose, 4.9 * root.col(k));
    EXPECT_TRUE(IsSameMode(f.mode, beside));
    EXPECT_FALSE(IsSameMode(f.mode, beside, 4.8));
    beside.pose = Retract(f.mode.pose, 5.1 * root.col(k));
    EXPECT_FALSE(IsSameMode(f.mode, beside));
  }
}

TEST(FindModes, TheFirstIsAsLikelyAsTheFitFromTheTruth) {
  for (const double factor : {0.25, 1.0, 4.0}) {
    for (std::uint32_t trial = 0; trial < 10; ++trial) {
      const FittedMode f = FitScene(200, 0.5, 0.4, trial, factor);
      RandomStream rng({.seed = 1, .trial = trial, .purpose = 2755});
      const HypothesisSearch search = SearchHypotheses(f.matches, ScoreMatches(f.matches), {}, rng);
      const std::vector<Mode> modes = FindModes(f.matches, f.prior, search.candidates, 6);
      ASSERT_FALSE(modes.empty());
      EXPECT_LE(modes.size(), 6U);
      EXPECT_GT(modes.front().log_likelihood, f.mode.log_likelihood - 0.1) << factor << " " << trial;
      for (size_t i = 1; i < modes.size(); ++i) {
        EXPECT_LE(modes[i].log_likelihood, modes[i - 1].log_likelihood);
        for (size_t k = 0; k < i; ++k) EXPECT_FALSE(IsSameMode(modes[k], modes[i]));
      }
    }
  }
}

TEST(FindModes, OfNoCandidateThereAreNone) {
  const FittedMode f = FitScene(20, 0.5, 0.0, 1);
  EXPECT_TRUE(FindModes(f.matches, f.prior, {}, 6).empty());
}

}  // namespace
}  // namespace rcme
