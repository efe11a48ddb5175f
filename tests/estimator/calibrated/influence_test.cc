#include "estimator/calibrated/influence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

double Logit(double p) { return std::log(p / (1.0 - p)); }

TEST(ProbabilityWrong, AddsTheLogOddsOfResidualAndInfluence) {
  const double at_twentieth = Logit(ProbabilityWrong(0.1, 0.2, 0.2)) - Logit(0.1);
  EXPECT_NEAR(at_twentieth, std::log(4.8), 1e-9);
  EXPECT_NEAR(Logit(ProbabilityWrong(0.02, 0.2, 0.2)) - Logit(0.02), at_twentieth, 1e-9);
  // Ten times the influence: 1.9 log 10 more.
  EXPECT_NEAR(Logit(ProbabilityWrong(0.1, 0.5, 0.05)) - Logit(0.1) - at_twentieth, 1.9 * std::log(10.0),
              1e-9);
}

TEST(ProbabilityWrong, IsAProbabilityWhateverComesIn) {
  for (const double p : {0.0, 1e-300, 0.5, 1.0}) {
    for (const double h : {0.0, 1e-12, 1.0}) {
      for (const double q : {0.0, 1e-12, 1.0}) {
        const double wrong = ProbabilityWrong(p, h, q);
        EXPECT_GE(wrong, 0.0);
        EXPECT_LE(wrong, 1.0);
      }
    }
  }
}

TEST(WrongByInfluence, IsZeroForMatchesThatTheModeDoesNotExplain) {
  const FittedMode f = FitScene(200, 0.5, 0.4, 3);
  const Explanation e = Explain(f.matches, f.mode);
  const std::vector<double> wrong = WrongByInfluence(f.mode, e);
  int num_zero = 0;
  for (size_t i = 0; i < wrong.size(); ++i) {
    EXPECT_EQ(wrong[i] > 0.0, e.probability[i] > 0.5) << i;
    num_zero += wrong[i] == 0.0;
  }
  EXPECT_GE(num_zero, 70);
}

// Of 200 matches 100 are wrong, and one lies on its epipolar line as a point ten times nearer than all others
// would: the geometry does not tell a wrong match there from a right one of such a point.
TEST(WrongByInfluence, FindsAWrongMatchOnItsEpipolarLine) {
  int num_found = 0, num_planted = 0, num_false = 0, num_right = 0;
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2791});
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 200, .min_depth = 40.0, .max_depth = 80.0});
    AddNoise(0.5, rng, &random.problem);
    const Camera& camera2 = random.problem.camera2;
    for (size_t i = 100; i < 200; ++i)
      random.problem.matches[i].x2_px << rng.Uniform(0.0, camera2.width), rng.Uniform(0.0, camera2.height);
    const Eigen::Vector3d ray = random.points_in_cam1[13] / random.points_in_cam1[13].z();
    random.problem.matches[13] =
        ProjectToBoth(5.0 * ray, random.pose_true, random.problem.camera1, random.problem.camera2);
    const FittedMode f = FitFromTruth(random.problem, random.pose_true);
    const Explanation e = Explain(f.matches, f.mode);
    if (!f.has_converged || e.probability[13] < 0.5) continue;
    const std::vector<double> wrong = WrongByInfluence(f.mode, e);
    ++num_planted;
    num_found += wrong[13] > 0.5;
    for (size_t i = 0; i < wrong.size(); ++i) {
      if (i == 13 || i >= 100 || e.probability[i] < 0.5) continue;
      ++num_right;
      num_false += wrong[i] > 0.5;
    }
  }
  EXPECT_GE(num_planted, 25);
  EXPECT_GE(num_found, num_planted * 6 / 10);
  EXPECT_LE(num_false, num_right / 200);
}

// The list does not evaluate every probability. It must hold the same matches, here under good motions and
// under bad ones.
TEST(WrongByInfluence, TheListHoldsThoseOfAtLeastOneHalf) {
  size_t num_listed = 0;
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    FittedMode f = FitScene(100, 0.5, 0.4, trial);
    f.mode.pose = Retract(f.mode.pose, (trial % 4) * 0.003 * Vector5d::Ones());
    const Explanation e = Explain(f.matches, f.mode);
    const std::vector<double> wrong = WrongByInfluence(f.mode, e);
    std::vector<size_t> expected;
    for (size_t i = 0; i < wrong.size(); ++i) {
      if (wrong[i] >= 0.5) expected.push_back(i);
    }
    EXPECT_EQ(ListWrongByInfluence(f.mode, e), expected) << trial;
    num_listed += expected.size();
  }
  EXPECT_GE(num_listed, 5U);
}

// Of 40 explained matches with leverages of 0.01 to 0.4 one in twenty exceeds 0.38: the 39th in rising order
// counts, and each match by its own share of it.
TEST(WrongByInfluence, IsRelativeToTheTwentieth) {
  Mode mode;
  mode.mixture.inlier_ratio = 0.8;
  mode.mixture.outlier_density = 1e-2;
  Explanation e;
  for (int i = 0; i < 45; ++i) {
    const bool is_explained = i < 40;
    e.probability.push_back(is_explained ? 0.9 : 0.1);
    e.leverage.push_back(is_explained ? 0.01 * (40 - i) : 0.9);
    e.left_out_density.push_back(0.3);
  }
  const std::vector<double> wrong = WrongByInfluence(mode, e);
  const double by_residual = 0.2 * 1e-2 / (0.8 * 0.3 + 0.2 * 1e-2);
  for (size_t i = 0; i < 45; ++i) {
    const double expected = i < 40 ? ProbabilityWrong(by_residual, e.leverage[i], 0.39) : 0.0;
    EXPECT_NEAR(wrong[i], expected, 1e-12) << i;
  }
}

}  // namespace
}  // namespace rcme
