// Templates of pairs whose answers and truths are known.
#include "experiments/real/truth_free/twin_source.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/geometry/sampson.h"
#include "experiments/real/truth_free/twin.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// Scene 1 and 40 right matches, each off its epipolar lines by its number of pixels; a given truth that may
// differ from the scene's.
struct Given {
  std::vector<double> off_px;
  double sigma_px = 0.5;
  std::optional<RelativePose> truth;
};
class GivenPairs : public DataSource {
 public:
  explicit GivenPairs(std::vector<Given> given) : given_(std::move(given)) {}
  int NumTrials(int) const override { return static_cast<int>(given_.size()); }
  TrialData Make(const StreamName& name) const override {
    const Given& given = given_.at(name.trial);
    RelativePose pose;
    TrialData pair;
    pair.problem = TwoCameraProblem(static_cast<int>(given.off_px.size()), 1e-9, 0.0, 1, &pose);
    pair.problem.sigma_px = given.sigma_px;
    const Eigen::Matrix3d F = ComputeFundamental(pair.problem, pose);
    for (size_t i = 0; i < given.off_px.size(); ++i) {
      Correspondence& match = pair.problem.matches[i];
      const Eigen::Vector4d u = EvaluateConstraint(F, match).gradient.normalized();
      match.x1_px += given.off_px[i] * u.head<2>();
      match.x2_px += given.off_px[i] * u.tail<2>();
    }
    pair.truth.cam2_from_cam1_true = given.truth;
    pair.origin = "pair_" + std::to_string(name.trial);
    return pair;
  }

 private:
  std::vector<Given> given_;
};

// The scene's motion as the answer, with no inliers but those said, and each pair's noise as its sigma.
class AnswersTheScene : public MotionEstimator {
 public:
  explicit AnswersTheScene(MotionStatus status = MotionStatus::kOk) : status_(status) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream&) const override {
    MotionEstimate estimate;
    estimate.status = status_;
    TwoCameraProblem(8, 0.5, 0.0, 1, &estimate.cam2_from_cam1);
    estimate.pose_cov = 1e-6 * Matrix5d::Identity();
    estimate.sigma_estimated_px = problem.sigma_px;
    return estimate;
  }

 private:
  MotionStatus status_;
};

RelativePose SceneMotion() {
  RelativePose pose;
  TwoCameraProblem(8, 0.5, 0.0, 1, &pose);
  return pose;
}
RelativePose OtherMotion() {
  return {RotationFromVector({0.0, 0.3, 0.0}) * SceneMotion().R, SceneMotion().t};
}

TwinSource Source(std::vector<Given> given, MotionStatus status = MotionStatus::kOk) {
  return AnswerScene("made", GivenPairs(std::move(given)), {}, AnswersTheScene(status), 1);
}

// Matches within four standard deviations are right and moved onto the motion, others stay wrong.
TEST(AnswerScene, TakesWhatIsWithinFourSigmaAsRight) {
  std::vector<double> off_px(40, 0.0);
  for (size_t i = 0; i < 10; ++i) off_px[i] = 0.5 * 3.9;
  for (size_t i = 10; i < 20; ++i) off_px[i] = 0.5 * 4.1;
  const TwinSource source = Source({{off_px, 0.5, {}}});
  ASSERT_TRUE(source.pairs[0].exact.has_value());
  const TrialData& exact = *source.pairs[0].exact;
  for (size_t i = 0; i < 40; ++i) EXPECT_EQ(exact.truth.is_inlier_true[i], i < 10 || i >= 20) << i;
  const Eigen::Matrix3d F = ComputeFundamental(exact.problem, SceneMotion());
  for (size_t i = 0; i < 10; ++i) EXPECT_LT(SquaredSampsonDistance(F, exact.problem.matches[i]), 1e-6);
  EXPECT_EQ(exact.problem.matches[12].x1_px, source.pairs[0].pair.problem.matches[12].x1_px);
  EXPECT_TRUE(source.pairs[0].HasAnsweredTemplate());
}

TEST(AnswerScene, NeedsTwentyRightMatches) {
  std::vector<double> off_px(40, 5.0);
  std::fill(off_px.begin(), off_px.begin() + 19, 0.0);
  std::vector<double> one_more = off_px;
  one_more[19] = 0.0;
  const TwinSource source = Source({{off_px, 0.5, {}}, {one_more, 0.5, {}}});
  EXPECT_FALSE(source.pairs[0].exact.has_value());
  EXPECT_TRUE(source.pairs[1].exact.has_value());
}

// The answer is the reference unless the given truth says that it failed, or there is none.
TEST(AnswerScene, RefersToTheTruthWhereTheAnswerFails) {
  const std::vector<double> off_px(40, 0.0);
  const TwinSource answered = Source({{off_px, 0.5, SceneMotion()}, {off_px, 0.5, OtherMotion()}});
  EXPECT_TRUE(answered.pairs[0].HasAnsweredTemplate());
  EXPECT_FALSE(answered.pairs[1].HasAnsweredTemplate());
  EXPECT_FALSE(answered.pairs[1].exact.has_value());  // hardly a match agrees with that truth
  const TwinSource refused =
      Source({{off_px, 0.5, SceneMotion()}, {off_px, 0.5, std::nullopt}}, MotionStatus::kNoCandidate);
  ASSERT_TRUE(refused.pairs[0].exact.has_value());
  EXPECT_EQ(refused.pairs[0].exact->truth.cam2_from_cam1_true->R, SceneMotion().R);
  EXPECT_FALSE(refused.pairs[0].HasAnsweredTemplate());
  EXPECT_FALSE(refused.pairs[1].exact.has_value());
}

// Noise of the pairs' answers over its median; 1 for templates without an answer.
TEST(AnswerScene, GivesEachPairItsLevelOfNoise) {
  const std::vector<double> off_px(40, 0.0);
  const TwinSource source =
      Source({{off_px, 0.2, {}}, {off_px, 0.4, {}}, {off_px, 1.2, {}}, {off_px, 0.4, OtherMotion()}});
  EXPECT_DOUBLE_EQ(source.pairs[0].noise_level, 0.5);
  EXPECT_DOUBLE_EQ(source.pairs[1].noise_level, 1.0);
  EXPECT_DOUBLE_EQ(source.pairs[2].noise_level, 3.0);
  EXPECT_EQ(source.pairs[3].noise_level, 1.0);
}

}  // namespace
}  // namespace rcme
