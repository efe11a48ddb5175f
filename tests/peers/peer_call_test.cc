// From a library's answer to an estimate: which matches agree, which covariance, and the status of whatever
// goes wrong. The libraries are lambdas.
#include "peers/peer_call.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace rcme {
namespace {

using testing::ElementsAre;
using testing::SizeIs;
using testing::StartsWith;

// The second camera is to the right of the first: epipolar lines are rows, and of a match that is e px off
// its row the squared Sampson distance is e^2 / 2. It agrees up to sqrt(2 chi2_2(0.95)) sigma = sqrt(2
// * 5.9915) 0.5 px = 1.731 px. Matches 20 to 23 are off by 1.7, 1.76, -1.7 and -1.76 px, the others by
// nothing.
class PeerCall : public testing::Test {
 protected:
  PeerCall() {
    problem_.camera1 = problem_.camera2 = {500.0, 500.0, 319.5, 239.5, 640, 480};
    problem_.sigma_px = 0.5;
    for (int i = 0; i < 24; ++i) {
      const Eigen::Vector2d x1_px(120.0 + 100.0 * (i % 5), 40.0 + 100.0 * (i / 5));  // NOLINT
      const double off_px = i < 20 ? 0.0 : (i % 2 == 0 ? 1.7 : 1.76) * (i < 22 ? 1.0 : -1.0);
      problem_.matches.push_back({x1_px, x1_px + Eigen::Vector2d(-50.0 - 10.0 * ((7 * i) % 11), off_px)});
    }
  }
  MotionEstimate Call(const RelativePose& pose, const std::vector<int>& inliers, int sample_size = 5) const {
    return CallPeer(problem_, sample_size, "Lib", [&] { return PeerAnswer{pose, inliers}; });
  }
  // Of every second of the first 20.
  static std::vector<int> Inliers() { return {18, 2, 4, 0, 6, 16, 10, 12, 14, 8}; }

  const RelativePose pose_{Eigen::Matrix3d::Identity(), -Eigen::Vector3d::UnitX()};
  MotionProblem problem_;
};

TEST_F(PeerCall, MatchesAgreeWithinTheThresholdTimesSigma) {
  std::vector<int> expected(21);
  for (int i = 0; i < 21; ++i) expected[static_cast<size_t>(i)] = i;
  expected.push_back(22);
  EXPECT_EQ(MatchesThatAgree(problem_, pose_), expected);
  problem_.sigma_px = 0.52;  // 1.800 px
  EXPECT_THAT(MatchesThatAgree(problem_, pose_), SizeIs(24));
  problem_.sigma_px = 0.49;  // 1.696 px
  EXPECT_THAT(MatchesThatAgree(problem_, pose_), SizeIs(20));
}

TEST_F(PeerCall, AnAnswerIsAnEstimate) {
  const MotionEstimate estimate = Call(pose_, Inliers());
  ASSERT_EQ(estimate.status, MotionStatus::kOk) << estimate.message;
  EXPECT_EQ(estimate.cam2_from_cam1.R, pose_.R);
  EXPECT_EQ(estimate.cam2_from_cam1.t, pose_.t);
  EXPECT_THAT(estimate.inliers, ElementsAre(0, 2, 4, 6, 8, 10, 12, 14, 16, 18));
  EXPECT_EQ(estimate.num_explained, 22);
}

// That of its inliers alone: of each match twice the information is twice as much, and other matches do not
// count.
TEST_F(PeerCall, TheCovarianceIsThatOfTheInliers) {
  const Matrix5d once = Call(pose_, Inliers()).pose_cov;
  for (const int i : Inliers()) problem_.matches.push_back(problem_.matches[static_cast<size_t>(i)]);
  EXPECT_EQ(Call(pose_, Inliers()).pose_cov, once);
  std::vector<int> twice = Inliers();
  for (int i = 24; i < 34; ++i) twice.push_back(i);
  EXPECT_LT((2.0 * Call(pose_, twice).pose_cov - once).norm(), 1e-9 * once.norm());
}

TEST_F(PeerCall, WhatGoesWrongHasItsStatus) {
  const MotionEstimate none = CallPeer(problem_, 5, "Lib", [] { return std::nullopt; });
  EXPECT_EQ(none.status, MotionStatus::kNoCandidate);
  EXPECT_EQ(none.message, "Lib found no motion");
  const MotionEstimate thrown = CallPeer(
      problem_, 5, "Lib", []() -> std::optional<PeerAnswer> { throw std::runtime_error("no such model"); });
  EXPECT_EQ(thrown.status, MotionStatus::kLibraryError);
  EXPECT_EQ(thrown.message, "Lib: no such model");
  EXPECT_EQ(Call(pose_, {3}).status, MotionStatus::kDegenerateMatches);
}

TEST_F(PeerCall, AMotionHasARotationAndADirection) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double length : {0.0, 0.5, 1.0 - 2e-6, 1.0 + 2e-6, 2.0, nan}) {
    const MotionEstimate estimate = Call({pose_.R, length * pose_.t}, Inliers());
    EXPECT_EQ(estimate.status, MotionStatus::kLibraryError) << length;
    EXPECT_THAT(estimate.message, StartsWith("Lib: its motion is not finite, or has no direction"));
  }
  EXPECT_EQ(Call({pose_.R, (1.0 + 5e-7) * pose_.t}, Inliers()).status, MotionStatus::kOk);
  EXPECT_EQ(Call({nan * pose_.R, pose_.t}, Inliers()).status, MotionStatus::kLibraryError);
}

TEST_F(PeerCall, ALibraryIsNotAskedWithFewerMatchesThanASample) {
  bool is_asked = false;
  const auto call = [&](size_t num_matches) {
    problem_.matches.resize(num_matches);
    is_asked = false;
    return CallPeer(problem_, 7, "Lib", [&]() -> std::optional<PeerAnswer> {
      is_asked = true;
      return std::nullopt;
    });
  };
  EXPECT_EQ(call(7).status, MotionStatus::kNoCandidate);
  EXPECT_TRUE(is_asked);
  EXPECT_EQ(call(6).status, MotionStatus::kTooFewMatches);
  EXPECT_FALSE(is_asked);
}

}  // namespace
}  // namespace rcme
