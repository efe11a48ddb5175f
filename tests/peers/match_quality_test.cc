// OpenCV's samplers that take the best matches first are given them in the order of
// MotionProblem::match_quality.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "estimator/noise_scale.h"
#include "tests/peers/peer_entries.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

MotionEstimate EstimateWith(const std::string& sampler, const MotionProblem& problem, std::uint32_t trial) {
  PeerEntries();  // adds them
  RandomStream rng({1, 0, trial, 4});
  return MakeEstimator("opencv_usac", {{"sampler", sampler}, {"max_iterations", "30"}})
      ->Estimate(problem, rng);
}

bool IsRight(const MotionEstimate& estimate, const RelativePose& pose_true) {
  return estimate.status == MotionStatus::kOk &&
         RotationAngleBetween(estimate.cam2_from_cam1.R, pose_true.R) <= 0.052 &&
         AngleBetween(estimate.cam2_from_cam1.t, pose_true.t) <= 0.26;
}

// Four of five matches are wrong. The quality of right ones has mean 2 and that of wrong ones 0, both with
// standard deviation 1.
struct ScoredProblem {
  MotionProblem problem;
  RelativePose pose_true;
};

ScoredProblem MakeScoredProblem(std::uint32_t trial) {
  const Scene scene = TwoCameraScene(200, trial);
  const Observation seen = ObserveTwoCameraScene(scene, 0.5, 0.8, trial);
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2741});
  MotionProblem problem{seen.matches, scene.camera1, scene.camera2, 0.5};
  for (const bool is_right : seen.is_inlier_true)
    problem.match_quality.push_back(rng.Normal() + (is_right ? 2.0 : 0.0));
  return {problem, scene.cam2_from_cam1_true};
}

MotionProblem WithShuffledQuality(MotionProblem problem, std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2742});
  rng.Shuffle(std::span(problem.match_quality));
  return problem;
}

// With 30 samples, in 600 trials: 598 motions found with qualities, 18 with shuffled and 19 without. Of
// 60 trials, fewer than 54 have a probability below 2e-4 at a rate of 0.98, and more than 9 below 2e-4 at
// 0.04.
TEST(MatchQuality, ProsacFindsMotionsAmongWrongMatchesByTheirQuality) {
  constexpr int kNumTrials = 60;
  int num_scored = 0, num_shuffled = 0, num_unscored = 0;
  for (std::uint32_t trial = 0; trial < kNumTrials; ++trial) {
    auto [problem, pose_true] = MakeScoredProblem(trial);
    num_scored += IsRight(EstimateWith("prosac", problem, trial), pose_true);
    num_shuffled += IsRight(EstimateWith("prosac", WithShuffledQuality(problem, trial), trial), pose_true);
    problem.match_quality.clear();
    num_unscored += IsRight(EstimateWith("prosac", problem, trial), pose_true);
  }
  EXPECT_GE(num_scored, 54);
  EXPECT_LE(num_shuffled, 9);
  EXPECT_LE(num_unscored, 9);
}

// Inliers have the indices of the problem: the same matches in any order of the rows.
TEST(MatchQuality, InliersAreThoseOfTheGivenOrder) {
  int num_found = 0;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const auto [problem, pose_true] = MakeScoredProblem(trial);
    const MotionEstimate estimate = EstimateWith("prosac", problem, trial);
    if (!IsRight(estimate, pose_true)) continue;
    ++num_found;
    std::vector<int> order(problem.matches.size());
    std::iota(order.begin(), order.end(), 0);
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2743});
    rng.Shuffle(std::span(order));
    const MotionEstimate of_shuffled = EstimateWith("prosac", SelectPart(problem, order), trial);
    EXPECT_EQ(of_shuffled.cam2_from_cam1.R, estimate.cam2_from_cam1.R);
    std::vector<int> inliers;
    for (const int i : of_shuffled.inliers) inliers.push_back(order[static_cast<size_t>(i)]);
    std::ranges::sort(inliers);
    EXPECT_EQ(inliers, estimate.inliers);
  }
  EXPECT_GE(num_found, 10);
}

// Equal qualities keep the order of the rows, and the other samplers do not look at them.
TEST(MatchQuality, EqualOnesChangeNothing) {
  ScoredProblem scored = MakeScoredProblem(0);
  const MotionEstimate uniform = EstimateWith("uniform", scored.problem, 0);
  scored.problem.match_quality.assign(200, 1.0);
  const MotionEstimate equal = EstimateWith("prosac", scored.problem, 0);
  scored.problem.match_quality.clear();
  EXPECT_EQ(EstimateWith("uniform", scored.problem, 0).inliers, uniform.inliers);
  EXPECT_EQ(EstimateWith("prosac", scored.problem, 0).inliers, equal.inliers);
}

}  // namespace
}  // namespace rcme
