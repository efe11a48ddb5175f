#include "experiments/trial/answer_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "estimator/estimator_registry.h"
#include "experiments/data/make_data.h"
#include "simulator/scene_registry.h"
#include "stats/constants.h"
#include "tests/test_support/estimator_variants.h"

namespace rcme {
namespace {

constexpr size_t kNumMatches = 10;

// A covariance whose rotation is known 1,000 times better than its direction, all coordinates correlated.
Matrix5d SoundCovariance() {
  Matrix5d half = Matrix5d::Identity();
  half(1, 0) = 0.5, half(3, 0) = -0.7, half(4, 3) = 0.9, half(3, 2) = 0.3;
  const Vector5d scale(1e-6, 2e-6, 1e-6, 1e-3, 2e-3);
  return scale.asDiagonal() * (half * half.transpose()) * scale.asDiagonal();
}

MotionEstimate SoundAnswer() {
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.cam2_from_cam1.R = RotationFromVector({0.1, -0.7, 0.4});
  estimate.cam2_from_cam1.t = Eigen::Vector3d(0.6, -0.3, 0.5).normalized();
  estimate.pose_cov = SoundCovariance();
  estimate.inliers = {0, 3, 9};
  estimate.num_support = estimate.num_explained = 10;
  return estimate;
}

struct Fault {
  std::string name;
  std::function<void(MotionEstimate&)> plant;
  MotionStatus expected;
  std::string said;  // in the message
};

std::vector<Fault> Faults() {
  constexpr auto kMotion = MotionStatus::kInvalidMotion;
  constexpr auto kCovariance = MotionStatus::kInvalidCovariance;
  using E = MotionEstimate;
  return {
      {"NaN in R", [](E& e) { e.cam2_from_cam1.R(1, 2) = kNaN; }, kMotion, "R is not a rotation"},
      {"infinity in R", [](E& e) { e.cam2_from_cam1.R(0, 0) = kInfinity; }, kMotion, "R is not a rotation"},
      {"reflection", [](E& e) { e.cam2_from_cam1.R *= -1.0; }, kMotion, "det R -1"},
      {"1000 R", [](E& e) { e.cam2_from_cam1.R *= 1000.0; }, kMotion, "R is not a rotation"},
      {"R of four digits",
       [](E& e) { e.cam2_from_cam1.R = (e.cam2_from_cam1.R.array() * 1e4).round() / 1e4; }, kMotion,
       "R is not a rotation"},
      {"zero R", [](E& e) { e.cam2_from_cam1.R.setZero(); }, kMotion, "R is not a rotation"},
      {"NaN in t", [](E& e) { e.cam2_from_cam1.t.y() = kNaN; }, kMotion, "t is not a unit vector"},
      {"t = 0", [](E& e) { e.cam2_from_cam1.t.setZero(); }, kMotion, "|t| = 0"},
      {"2 t", [](E& e) { e.cam2_from_cam1.t *= 2.0; }, kMotion, "|t| = 2"},
      {"NaN in the covariance", [](E& e) { e.pose_cov(4, 1) = kNaN; }, kCovariance, "covariance"},
      {"infinite variance", [](E& e) { e.pose_cov(3, 3) = kInfinity; }, kCovariance, "covariance"},
      {"asymmetric in the small block", [](E& e) { e.pose_cov(0, 1) *= 1.001; }, kCovariance, "symmetric"},
      {"negative variance", [](E& e) { e.pose_cov *= -1.0; }, kCovariance, "semidefinite"},
      {"correlation of 1.001",
       [](E& e) {
         e.pose_cov.setIdentity();
         e.pose_cov(0, 1) = e.pose_cov(1, 0) = 1.001;
       },
       kCovariance, "semidefinite"},
      {"covariance of what is known exactly",
       [](E& e) {
         e.pose_cov.setZero();
         e.pose_cov(0, 0) = 1.0;
         e.pose_cov(0, 4) = e.pose_cov(4, 0) = 1e-9;
       },
       kCovariance, "covariance"},
      {"inlier beyond the last match",
       [](E& e) {
         e.inliers = {0, 10};
       },
       kMotion, "inlier 10 "},
      {"negative inlier",
       [](E& e) {
         e.inliers = {-1, 3};
       },
       kMotion, "inlier -1 "},
      {"repeated inlier",
       [](E& e) {
         e.inliers = {3, 4, 3};
       },
       kMotion, "inlier 3 is there twice"},
      {"negative support", [](E& e) { e.num_support = -1; }, kMotion, "num_support is -1"},
      {"more explained than there are", [](E& e) { e.num_explained = 11; }, kMotion, "11 of 10"},
      {"negative hypotheses", [](E& e) { e.counts.num_candidates = -5; }, kMotion, "-5"},
      {"no status", [](E& e) { e.status = static_cast<MotionStatus>(99); }, kMotion, "status 99"},
  };
}

TEST(AnswerCheck, EveryFaultIsNamed) {
  ASSERT_FALSE(FindFault(SoundAnswer(), kNumMatches));
  for (const Fault& fault : Faults()) {
    SCOPED_TRACE(fault.name);
    MotionEstimate estimate = SoundAnswer();
    fault.plant(estimate);
    const std::optional<AnswerFault> found = FindFault(estimate, kNumMatches);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->status, fault.expected);
    EXPECT_THAT(found->message, testing::HasSubstr(fault.said));
    const MotionEstimate judged = Judged(estimate, kNumMatches);
    EXPECT_EQ(judged.status, fault.expected);
    EXPECT_EQ(judged.message, found->message);
    for (const int index : judged.inliers) EXPECT_TRUE(index >= 0 && index < 10);
    EXPECT_FALSE(FindFault(judged, kNumMatches)) << "a second judgement finds nothing new";
  }
}

// What rounding makes of a sound answer passes: single precision, and a covariance that is singular or was
// inverted from an ill-conditioned matrix.
TEST(AnswerCheck, RoundingPasses) {
  for (int i = 0; i < 1000; ++i) {
    MotionEstimate estimate = SoundAnswer();
    RandomStream rng({.seed = 1, .trial = static_cast<std::uint32_t>(i), .purpose = 150});
    Eigen::Matrix3f R = Eigen::Matrix3f::Identity();
    for (int k = 0; k < 3; ++k) {
      R *= RotationFromVector({rng.Normal(), rng.Normal(), rng.Normal()}).cast<float>();
    }
    estimate.cam2_from_cam1.R = R.cast<double>();
    estimate.cam2_from_cam1.t =
        Eigen::Vector3f(Eigen::Vector3d(rng.Normal(), rng.Normal(), rng.Normal()).cast<float>())
            .normalized()
            .cast<double>();
    Eigen::Matrix<double, 5, 3> half;  // rank 3
    for (double& x : half.reshaped()) x = rng.Normal();
    estimate.pose_cov = half * half.transpose();
    const std::optional<AnswerFault> fault = FindFault(estimate, kNumMatches);
    EXPECT_FALSE(fault) << fault->message;
  }
  MotionEstimate exact = SoundAnswer();
  exact.pose_cov.setZero();
  EXPECT_FALSE(FindFault(exact, kNumMatches)) << "the score says what it is worth: NEES is infinite";
}

// A refusal promises no motion, only an account that can be; without a direction it promises the rotation.
TEST(AnswerCheck, ARefusalIsHeldToWhatItPromises) {
  MotionEstimate refusal;
  refusal.cam2_from_cam1.R.setConstant(kNaN);
  refusal.status = MotionStatus::kNoCandidate;
  EXPECT_FALSE(FindFault(refusal, 0));
  refusal.status = MotionStatus::kDirectionNotObservable;
  EXPECT_TRUE(FindFault(refusal, 0));
  refusal.cam2_from_cam1.R.setIdentity();
  refusal.cam2_from_cam1.t.setConstant(kNaN);
  refusal.pose_cov.setConstant(kNaN);
  EXPECT_FALSE(FindFault(refusal, 0));
  refusal.inliers = {0};
  EXPECT_TRUE(FindFault(refusal, 0));
}

// No false alarm: every estimator of the registry in both readings on every scene, with few and many wrong
// matches, and a camera pair that differs.
TEST(AnswerCheck, TheBuiltInEstimatorsPassOnEveryScene) {
  int num_ok = 0;
  for (const SceneEntry& scene : SceneRegistry()) {
    for (const char* outlier_ratio : {"0", "0.5"}) {
      const DataSources sources = MakeDataSources({{"scene", scene.name},
                                                   {"num_matches", "60"},
                                                   {"outlier_ratio", outlier_ratio},
                                                   {"severity", "skipped"}});
      for (std::uint32_t trial = 0; trial < 4; ++trial) {
        const StreamName name{1, 0, trial, 0};
        const TrialData data = sources.sources.front().second->Make(name);
        for (const EstimatorVariant& variant : EstimatorVariants({"reading"})) {
          RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
          const MotionEstimate estimate = variant.Make()->Estimate(data.problem, rng);
          const std::optional<AnswerFault> fault = FindFault(estimate, data.problem.matches.size());
          EXPECT_FALSE(fault) << variant.name << " on " << scene.name << ": " << fault->message;
          num_ok += estimate.status == MotionStatus::kOk;
        }
      }
    }
  }
  EXPECT_GT(num_ok, 100) << "answers that are all refusals test nothing";
}

}  // namespace
}  // namespace rcme
