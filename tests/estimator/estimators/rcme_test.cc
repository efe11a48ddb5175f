// What the parts of RCME do when each is turned on or off: the same loop, the same samples.
#include "estimator/estimators/rcme.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

#include "estimator/estimators/standard.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

MotionProblem MakeProblem(double outlier_ratio, std::uint32_t trial, RelativePose* pose_true = nullptr) {
  return TwoCameraProblem(500, 0.5, outlier_ratio, trial, pose_true);
}

MotionEstimate RunOn(const MotionEstimator& estimator, const MotionProblem& problem,
                     std::uint32_t trial = 0) {
  RandomStream rng({1, 0, trial, 4});
  return estimator.Estimate(problem, rng);
}

constexpr auto kOn = SampleTest::kOn;
constexpr auto kOff = SampleTest::kOff;

TEST(Rcme, TheSampleTestIsTheOnlyDifferenceToPrcme) {
  const MotionProblem problem = MakeProblem(0.2, 0);
  const LoopCounts with = RunOn(*MakeRcme({}, kOn), problem).counts;
  const LoopCounts without = RunOn(*MakeRcme({}, kOff), problem).counts;
  EXPECT_EQ(without.num_inconsistent_samples, 0);
  EXPECT_GT(with.num_inconsistent_samples, 100);  // 83 % of samples hold an outlier
  EXPECT_EQ(with.num_degenerate_samples, without.num_degenerate_samples);
}

TEST(Rcme, AStricterMuRefusesMore) {
  const MotionProblem problem = MakeProblem(0.2, 0);
  const auto run_at = [&](double mu) {
    RansacOptions options;
    options.mu = mu;
    return RunOn(*MakeRcme(options, kOff), problem);
  };
  EXPECT_EQ(run_at(-1000.0).status, MotionStatus::kNoCandidate);
  EXPECT_EQ(run_at(-1000.0).counts.num_poor_inlier_sets, 200);
  EXPECT_GT(run_at(-3.53).counts.num_poor_inlier_sets, run_at(1000.0).counts.num_poor_inlier_sets);
  EXPECT_EQ(run_at(1000.0).status, MotionStatus::kOk);
}

TEST(Rcme, TheLevelAlphaTestPassesNoMoreThanThePrintedOne) {
  const MotionProblem problem = MakeProblem(0.2, 0);
  RansacOptions options;
  const int printed = RunOn(*MakeRcme(options, kOff), problem).counts.num_poor_inlier_sets;
  options.quality_test = QualityTest::kLevelAlpha;
  const int level = RunOn(*MakeRcme(options, kOff), problem).counts.num_poor_inlier_sets;
  EXPECT_GE(level, printed);
}

TEST(Rcme, TheSizeConditionUsesTheGivenInlierRatio) {
  const MotionProblem problem = MakeProblem(0.5, 0);
  RansacOptions options;
  options.mu = 1000.0;
  options.lambda = 1.0;
  options.inlier_ratio = 1.0;  // no model can have all matches as inliers
  const MotionEstimate refused = RunOn(*MakeRcme(options, kOff), problem);
  EXPECT_EQ(refused.status, MotionStatus::kNoCandidate);
  EXPECT_GT(refused.counts.num_too_small_inlier_sets, 0);
  options.inlier_ratio = 0.0;
  EXPECT_EQ(RunOn(*MakeRcme(options, kOff), problem).counts.num_too_small_inlier_sets, 0);
}

TEST(Rcme, EarlyStopEndsAtTheFirstCandidateBelowTheThreshold) {
  const MotionProblem problem = MakeProblem(0.0, 0);
  RansacOptions options;
  const MotionEstimate whole = RunOn(*MakeRcme(options, kOn), problem);
  EXPECT_EQ(whole.counts.num_hypotheses, options.num_iterations);
  options.early_stop_entropy = 1000.0;
  const MotionEstimate early = RunOn(*MakeRcme(options, kOn), problem);
  EXPECT_LT(early.counts.num_hypotheses, options.num_iterations);
  EXPECT_EQ(early.counts.num_candidates, 1);
}

TEST(Rcme, SelectionTakesTheLeastMeanEntropy) {
  const MotionProblem problem = MakeProblem(0.0, 0);
  RansacOptions options;
  options.lambda = 0.0;
  const double of_many = RunOn(*MakeRcme(options, kOn), problem).mean_entropy;
  options.num_iterations = 20;
  EXPECT_LE(of_many, RunOn(*MakeRcme(options, kOn), problem).mean_entropy);
}

TEST(Rcme, RefinementNoneReturnsTheWinnerItself) {
  const MotionProblem problem = MakeProblem(0.0, 0);
  RansacOptions options;
  options.refinement = Refinement::kNone;
  const MotionEstimate estimate = RunOn(*MakeRcme(options, kOn), problem);
  EXPECT_EQ(estimate.cam2_from_cam1.R, estimate.initial_pose.R);
  EXPECT_EQ(estimate.num_consistent_before, estimate.num_consistent_after);
}

// OpenCV's essential matrix and pose on the same clean matches: another implementation, the same motion.
TEST(Standard, AgreesWithOpenCv) {
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    RelativePose pose_true;
    const MotionProblem problem = MakeProblem(0.1, trial, &pose_true);
    std::vector<cv::Point2d> x1, x2;
    for (const Correspondence& match : problem.matches) {
      x1.emplace_back(match.x1_px.x(), match.x1_px.y());
      const Eigen::Vector2d x2_px = problem.camera1.Project(problem.camera2.Ray(match.x2_px));
      x2.emplace_back(x2_px.x(), x2_px.y());  // OpenCV takes one camera: as if camera 1 had seen it
    }
    const Camera& c = problem.camera1;
    const cv::Mat K = (cv::Mat_<double>(3, 3) << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
    cv::Mat mask, R, t;
    const cv::Mat E = cv::findEssentialMat(x1, x2, K, cv::USAC_MAGSAC, 0.9999, 1.5, mask);
    cv::recoverPose(E, x1, x2, K, R, t, mask);
    RelativePose cv_pose;
    for (int r = 0; r < 3; ++r) {
      for (int col = 0; col < 3; ++col) cv_pose.R(r, col) = R.at<double>(r, col);
      cv_pose.t(r) = t.at<double>(r);
    }
    const MotionEstimate estimate = RunOn(*MakeStandard({}), problem, trial);
    ASSERT_EQ(estimate.status, MotionStatus::kOk);
    EXPECT_LT(RotationAngleBetween(estimate.cam2_from_cam1.R, cv_pose.R), 0.02);
    EXPECT_LT(AngleBetween(estimate.cam2_from_cam1.t, cv_pose.t), 0.15);
  }
}

}  // namespace
}  // namespace rcme
