// What the call of each library is given, where its answers alone hardly show it: samples, thresholds, local
// optimisations, and which of several answers is taken.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <tuple>

#include "estimator/geometry/essential_matrix.h"
#include "tests/peers/peer_entries.h"
#include "tests/test_support/linear_algebra.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

MotionEstimate AskPeer(const std::string& name, const Settings& options, const MotionProblem& problem,
                       std::uint32_t trial) {
  PeerEntries();
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 4});
  return MakeEstimator(name, options)->Estimate(problem, rng);
}

TEST(PeerAdapters, SayHowManyMatchesASampleTakes) {
  const std::vector<std::tuple<const char*, Settings, int>> peers = {
      {"opencv_usac", {}, 5},
      {"opencv_ransac", {}, 7},
      {"opencv_lmeds", {}, 7},
      {"opengv_ransac", {{"algorithm", "five_point_nister"}}, 8},
      {"opengv_ransac", {{"algorithm", "five_point_stewenius"}}, 8},
      {"opengv_ransac", {{"algorithm", "seven_point"}}, 9},
      {"opengv_ransac", {{"algorithm", "eight_point"}}, 9}};
  const MotionProblem problem = TwoCameraProblem(4, 0.5, 0.0, 0);
  for (const auto& [name, options, least] : peers) {
    const MotionEstimate estimate = AskPeer(name, options, problem, 0);
    EXPECT_EQ(estimate.status, MotionStatus::kTooFewMatches) << name;
    EXPECT_THAT(estimate.message, testing::HasSubstr(fmt::format("at least {} are needed", least))) << name;
  }
}

// Seven exact matches have up to three F. One of them is the true one, which has all points in front; in four
// problems of five another has fewer.
TEST(PeerAdapters, OfThreeAnswersToSevenMatchesTheOneWithMostPointsInFront) {
  for (const char* name : {"opencv_ransac", "opencv_lmeds"}) {
    for (std::uint32_t trial = 0; trial < 20; ++trial) {
      MotionProblem problem = TwoCameraProblem(7, 0.0, 0.0, trial);
      problem.sigma_px = 0.01;
      const MotionEstimate estimate = AskPeer(name, {}, problem, trial);
      EXPECT_EQ(estimate.inliers.size(), 7u) << name << ", trial " << trial << ": " << estimate.message;
    }
  }
}

// The second camera's principal point, and its points, moved by 400 px: the rays are as before. In the rays
// of camera 1 they would be off by 30 degrees, and in some problems a third of the points behind a camera.
TEST(PeerAdapters, PointsAreInFrontByTheRaysOfTheirOwnCameras) {
  for (const char* name : {"opencv_usac", "opencv_ransac", "opencv_lmeds"}) {
    for (std::uint32_t trial = 0; trial < 5; ++trial) {
      MotionProblem problem = TwoCameraProblem(100, 0.0, 0.0, trial);
      problem.sigma_px = 0.01;
      problem.camera2.cx += 400.0;
      for (Correspondence& match : problem.matches) match.x2_px.x() += 400.0;
      EXPECT_GT(AskPeer(name, {}, problem, trial).inliers.size(), 90u) << name << ", trial " << trial;
    }
  }
}

// E with singular values 1, 1, 0.
Eigen::Matrix3d NearestEssential(const cv::Mat& E) {
  Eigen::Matrix3d given;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) given(row, col) = E.at<double>(row, col);
  }
  const FullSvd svd(given);
  return svd.U.leftCols(2) * svd.V.leftCols(2).transpose();
}

// What the peer asks by default but for the local optimisation, written out.
Eigen::Matrix3d AskUsacDirectly(const MotionProblem& problem, cv::UsacParams params, std::uint32_t trial) {
  params.score = cv::SCORE_METHOD_MSAC;
  params.sampler = cv::SAMPLING_UNIFORM;
  params.threshold = 2.0;  // of two standard deviations, 2 * 0.5 px each
  params.confidence = 0.99;
  params.maxIterations = 5000;
  params.isParallel = false;
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 4});
  params.randomGeneratorState = static_cast<int>(rng.Next32() >> 2);
  std::vector<cv::Point2d> points1, points2;
  for (const Correspondence& match : problem.matches) {
    points1.emplace_back(match.x1_px.x(), match.x1_px.y());
    points2.emplace_back(match.x2_px.x(), match.x2_px.y());
  }
  const auto K = [](const Camera& c) { return cv::Matx33d(c.fx, 0.0, c.cx, 0.0, c.fy, c.cy, 0.0, 0.0, 1.0); };
  cv::Mat mask;
  return NearestEssential(cv::findEssentialMat(points1, points2, K(problem.camera1), K(problem.camera2),
                                               cv::noArray(), cv::noArray(), mask, params));
}

// Each local optimisation with the number and the size of the samples that OpenCV's own choice of it has for
// essential matrices.
TEST(PeerAdapters, EachLocalOptimisationOfUsacHasItsOwnSamples) {
  const std::vector<std::tuple<const char*, cv::LocalOptimMethod, int, int>> all = {
      {"inner", cv::LOCAL_OPTIM_INNER_LO, 15, 21},
      {"graph_cut", cv::LOCAL_OPTIM_GC, 25, 20},
      {"sigma", cv::LOCAL_OPTIM_SIGMA, 10, 50}};
  for (const auto& [word, method, num_samples, sample_size] : all) {
    cv::UsacParams params;
    params.loMethod = method;
    params.loIterations = num_samples;
    params.loSampleSize = sample_size;
    for (std::uint32_t trial = 0; trial < 5; ++trial) {
      const MotionProblem problem = TwoCameraProblem(150, 0.5, 0.3, trial);
      const MotionEstimate estimate = AskPeer("opencv_usac", {{"local_optimisation", word}}, problem, trial);
      ASSERT_EQ(estimate.status, MotionStatus::kOk) << word << ": " << estimate.message;
      const Eigen::Matrix3d E = EssentialFromPose(estimate.cam2_from_cam1),
                            direct = AskUsacDirectly(problem, params, trial);
      EXPECT_LT(std::min((E - direct).norm(), (E + direct).norm()), 1e-6) << word << ", trial " << trial;
    }
  }
}

// The same rays seen by two cameras of 1000 px with images of one pixel, whose mean squared angle of a pixel
// is 1e-6 rad^2, have the same inliers at the threshold times sqrt((S1 + S2) / (2e-6)). S1 = 1.89447876e-6
// and S2 = 1.21241571e-6 rad^2 are those of the two cameras: NumPy, angles by cross products of rays 2e-3 px
// apart along either axis, mean over the centres of 8 x 8 cells.
TEST(PeerAdapters, OpenGvsThresholdIsTheMeanAngleOfAPixelInBothImages) {
  constexpr double kSquaredAngles = 1.8944787640e-6 + 1.2124157068e-6;
  const std::string equal = fmt::format("{}", 2.0 * std::sqrt(kSquaredAngles / 2e-6));
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    const MotionProblem problem = TwoCameraProblem(200, 0.5, 0.1, trial);
    MotionProblem on_axis = problem;
    on_axis.camera1 = on_axis.camera2 = {1000.0, 1000.0, 0.0, 0.0, 1, 1};
    for (Correspondence& match : on_axis.matches) {
      match.x1_px = 1000.0 * problem.camera1.Ray(match.x1_px).head<2>();
      match.x2_px = 1000.0 * problem.camera2.Ray(match.x2_px).head<2>();
    }
    const MotionEstimate one =
        AskPeer("opengv_ransac", {{"refinement", "none"}, {"threshold_sigma", "2"}}, problem, trial);
    const MotionEstimate other =
        AskPeer("opengv_ransac", {{"refinement", "none"}, {"threshold_sigma", equal}}, on_axis, trial);
    ASSERT_EQ(one.status, MotionStatus::kOk) << one.message;
    EXPECT_EQ(one.inliers, other.inliers) << trial;
  }
}

// The refinement begins at what RANSAC found, which the same stream gives without it: motion and inliers are
// others after it.
TEST(PeerAdapters, OpenGvsInliersAreThoseOfTheRefinedMotion) {
  int num_other_motions = 0, num_other_inliers = 0;
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const MotionProblem problem = TwoCameraProblem(150, 0.5, 0.2, trial);
    const MotionEstimate before = AskPeer("opengv_ransac", {{"refinement", "none"}}, problem, trial);
    const MotionEstimate after = AskPeer("opengv_ransac", {{"refinement", "nonlinear"}}, problem, trial);
    num_other_motions += before.cam2_from_cam1.R != after.cam2_from_cam1.R;
    num_other_inliers += before.inliers != after.inliers;
  }
  EXPECT_GE(num_other_motions, 8);
  EXPECT_GE(num_other_inliers, 5);
}

// Of nine matches, eight of them a sample, one is wrong: where it stands in the list does not matter to
// samples of which all are equally likely. 1,000 streams with it in the fifth place and 1,000 with it in the
// last, at most two samples each: the rates of right motions differ by more than 0.074 in 0.1 % of
// experiments at most (3.3 standard errors of at most 0.0224). Were each match swapped with any of the nine,
// and not with those behind it, they would differ by 0.17 or more by a simulation of the swaps (the last one
// stays out of a sample four times as often), which is found but in one of 10^5.
TEST(PeerAdapters, OpenGvsSamplesAreEquallyLikely) {
  RelativePose pose_true;
  MotionProblem problem = TwoCameraProblem(9, 0.0, 0.0, 0, &pose_true);
  problem.sigma_px = 0.01;
  problem.matches[8].x2_px += Eigen::Vector2d(60.0, -80.0);
  const Settings options = {{"refinement", "none"}, {"max_iterations", "1"}, {"confidence", "0.01"}};
  const auto rate_with_it_at = [&](size_t place, std::uint32_t first_trial) {
    MotionProblem moved = problem;
    std::swap(moved.matches[place], moved.matches[8]);
    int num_right = 0;
    for (std::uint32_t trial = first_trial; trial < first_trial + 1000; ++trial) {
      const MotionEstimate estimate = AskPeer("opengv_ransac", options, moved, trial);
      num_right += estimate.status == MotionStatus::kOk &&
                   RotationAngleBetween(estimate.cam2_from_cam1.R, pose_true.R) < 1e-3 &&
                   AngleBetween(estimate.cam2_from_cam1.t, pose_true.t) < 1e-2;
    }
    return num_right / 1000.0;
  };
  const double fifth = rate_with_it_at(4, 0), last = rate_with_it_at(8, 1000);
  EXPECT_GT(fifth, 0.05);
  EXPECT_NEAR(fifth, last, 0.074);
}

}  // namespace
}  // namespace rcme
