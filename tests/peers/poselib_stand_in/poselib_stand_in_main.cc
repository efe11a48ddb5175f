// What peers/poselib.cc asks of PoseLib, and what it makes of the answer, by a stand-in: where PoseLib itself
// is not there.
#include <PoseLib/poselib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "parameters/parameter.h"
#include "peers/peers.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

using poselib::TheStandIn;
using testing::ElementsAre;
using testing::HasSubstr;

class PoseLibAdapter : public testing::Test {
 protected:
  PoseLibAdapter() : problem_(TwoCameraProblem(40, 0.5, 0.0, 0, &pose_true_)) {
    TheStandIn().calls.clear();
    TheStandIn().answer = [this](poselib::CameraPose* pose, std::vector<char>* inliers) {
      const Eigen::Quaterniond q(pose_true_.R);
      pose->q << q.w(), q.x(), q.y(), q.z();
      pose->t = 2.5 * pose_true_.t;
      inliers->assign(40, 1);
      (*inliers)[0] = (*inliers)[7] = 0;
      return poselib::RansacStats{38};
    };
  }
  MotionEstimate Estimate(const std::vector<std::pair<std::string, std::string>>& options = {},
                          std::uint32_t stream = 0) const {
    const std::unique_ptr<EstimatorModel> model = PoseLibModel();
    const std::vector<Parameter> parameters = model->Parameters();
    for (const auto& [name, value] : options) FindParameter(parameters, name).SetFromText(value);
    RandomStream rng({.seed = 1, .trial = stream, .purpose = 4});
    return model->Make()->Estimate(problem_, rng);
  }

  RelativePose pose_true_;
  MotionProblem problem_;
};

TEST_F(PoseLibAdapter, AsksWithTheProblemAndTheOptions) {
  Estimate(
      {{"threshold_sigma", "3"}, {"confidence", "0.9"}, {"min_iterations", "10"}, {"max_iterations", "70"}});
  ASSERT_EQ(TheStandIn().calls.size(), 1u);
  const poselib::StandInCall& call = TheStandIn().calls[0];
  EXPECT_EQ(call.points1.size(), 40u);
  EXPECT_EQ(call.points1[3], problem_.matches[3].x1_px);
  EXPECT_EQ(call.points2[3], problem_.matches[3].x2_px);
  EXPECT_EQ(call.cameras[0].model, "PINHOLE");
  const Camera &c1 = problem_.camera1, &c2 = problem_.camera2;
  EXPECT_THAT(call.cameras[0].params, ElementsAre(c1.fx, c1.fy, c1.cx, c1.cy));
  EXPECT_THAT(call.cameras[1].params, ElementsAre(c2.fx, c2.fy, c2.cx, c2.cy));
  EXPECT_EQ(call.cameras[1].width, c2.width);
  EXPECT_DOUBLE_EQ(call.options.max_epipolar_error, 3.0 * 0.5);
  EXPECT_DOUBLE_EQ(call.options.success_prob, 0.9);
  EXPECT_EQ(call.options.min_iterations, 10u);
  EXPECT_EQ(call.options.max_iterations, 70u);
}

TEST_F(PoseLibAdapter, TakesItsSeedFromTheStream) {
  for (const std::uint32_t stream : {0, 0, 1}) Estimate({}, stream);
  const auto seed = [](size_t i) { return TheStandIn().calls[i].options.seed; };
  EXPECT_EQ(seed(0), seed(1));
  EXPECT_NE(seed(0), seed(2));
}

TEST_F(PoseLibAdapter, MakesAnEstimateOfTheAnswer) {
  const MotionEstimate estimate = Estimate();
  ASSERT_EQ(estimate.status, MotionStatus::kOk) << estimate.message;
  EXPECT_LT((estimate.cam2_from_cam1.R - pose_true_.R).norm(), 1e-12);
  EXPECT_LT((estimate.cam2_from_cam1.t - pose_true_.t).norm(), 1e-12);
  EXPECT_EQ(estimate.inliers.size(), 38u);
  EXPECT_EQ(estimate.inliers[0], 1);
  EXPECT_GT(estimate.pose_cov.diagonal().minCoeff(), 0.0);
}

TEST_F(PoseLibAdapter, SaysWhatWentWrong) {
  TheStandIn().answer = [](poselib::CameraPose*, std::vector<char>*) { return poselib::RansacStats{}; };
  EXPECT_EQ(Estimate().status, MotionStatus::kNoCandidate);
  TheStandIn().answer = [](poselib::CameraPose*, std::vector<char>*) -> poselib::RansacStats {
    throw std::runtime_error("no such camera");
  };
  EXPECT_EQ(Estimate().status, MotionStatus::kLibraryError);
  EXPECT_THAT(Estimate().message, HasSubstr("PoseLib: no such camera"));
  TheStandIn().answer = [](poselib::CameraPose* pose, std::vector<char>* inliers) {
    pose->t.setZero();  // of no direction
    inliers->assign(40, 1);
    return poselib::RansacStats{40};
  };
  EXPECT_EQ(Estimate().status, MotionStatus::kLibraryError);
  TheStandIn().answer = [this](poselib::CameraPose* pose, std::vector<char>* inliers) {
    pose->t = pose_true_.t;
    inliers->assign(40, 0);
    inliers->at(0) = 1;
    return poselib::RansacStats{1};
  };
  EXPECT_EQ(Estimate().status, MotionStatus::kDegenerateMatches);
}

TEST_F(PoseLibAdapter, IsNotAskedWhatCannotBeSolved) {
  problem_.matches[2].x1_px.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Estimate().status, MotionStatus::kInvalidInput);
  problem_.matches.resize(2);
  EXPECT_EQ(Estimate().status, MotionStatus::kTooFewMatches);
  EXPECT_TRUE(TheStandIn().calls.empty());
}

}  // namespace
}  // namespace rcme
