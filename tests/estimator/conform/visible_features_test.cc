#include "estimator/conform/visible_features.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/estimator_registry.h"
#include "estimator/geometry/pose.h"
#include "stats/constants.h"
#include "tests/test_support/family_problem.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

double At(const VisibleFeatures& features, VisibleFeature feature) {
  return features[static_cast<size_t>(feature)];
}

// Exact matches and the true motion, with a covariance of rotation .01, direction .02 rad (root of the
// traces).
struct Exact {
  RandomProblem made;
  MotionEstimate estimate;
};
Exact MakeExact(int num_matches) {
  RandomStream rng({.seed = 1, .purpose = 100});
  RandomProblemOptions options;
  options.num_matches = num_matches;
  Exact exact{MakeRandomProblem(rng, options), {}};
  exact.estimate.status = MotionStatus::kOk;
  exact.estimate.cam2_from_cam1 = exact.made.pose_true;
  exact.estimate.pose_cov = Matrix5d::Zero();
  exact.estimate.pose_cov.diagonal() << 1e-4 / 3, 1e-4 / 3, 1e-4 / 3, 2e-4, 2e-4;
  for (int i = 0; i < num_matches; ++i) exact.estimate.inliers.push_back(i);
  return exact;
}

TEST(VisibleFeatures, OfExactMatches) {
  Exact exact = MakeExact(80);
  exact.estimate.failure_probability = 0.2;
  const VisibleFeatures features = MeasureVisibleFeatures(exact.made.problem, exact.estimate);
  EXPECT_DOUBLE_EQ(At(features, VisibleFeature::kMatches), std::log(81.0));
  EXPECT_DOUBLE_EQ(At(features, VisibleFeature::kAgreeing), std::log(81.0));
  EXPECT_DOUBLE_EQ(At(features, VisibleFeature::kAgreeingShare), std::log(81.0));
  EXPECT_DOUBLE_EQ(At(features, VisibleFeature::kResidual), std::log(1e-3));
  EXPECT_NEAR(At(features, VisibleFeature::kRotationSd), std::log(1e-2), 1e-12);
  EXPECT_NEAR(At(features, VisibleFeature::kDirectionSd), std::log(2e-2), 1e-12);
  EXPECT_NEAR(At(features, VisibleFeature::kStatedOdds), std::log(0.25), 1e-12);
  const RelativePose& pose = exact.made.pose_true;
  EXPECT_DOUBLE_EQ(At(features, VisibleFeature::kAxialShare), std::abs(pose.t.z()));
  EXPECT_NEAR(At(features, VisibleFeature::kRotation),
              std::log(0.1 + kDegPerRad * VectorFromRotation(pose.R).norm()), 1e-9);
}

// Residuals of sigma have the scale 1; half the assumed noise halves it. 500 matches: the median's relative
// standard error is .06.
TEST(VisibleFeatures, ResidualsAreInUnitsOfTheAssumedNoise) {
  Exact exact = MakeExact(500);
  RandomStream rng({.seed = 1, .purpose = 101});
  for (Correspondence& match : exact.made.problem.matches) {
    match.x1_px += exact.made.problem.sigma_px * Eigen::Vector2d(rng.Normal(), rng.Normal());
    match.x2_px += exact.made.problem.sigma_px * Eigen::Vector2d(rng.Normal(), rng.Normal());
  }
  const double scale =
      At(MeasureVisibleFeatures(exact.made.problem, exact.estimate), VisibleFeature::kResidual);
  EXPECT_NEAR(scale, 0.0, 0.25);
  exact.made.problem.sigma_px *= 2.0;
  const VisibleFeatures halved = MeasureVisibleFeatures(exact.made.problem, exact.estimate);
  EXPECT_NEAR(At(halved, VisibleFeature::kResidual), scale - std::log(2.0), 1e-9);
}

// A point at depth Z moved sideways by b has the parallax f b / Z px: all alike here, 600 * .5 / 10 = 30 px,
// over sqrt(2) sigma. The points lie on a plane, so that one homography explains them all.
TEST(VisibleFeatures, ParallaxAndPlaneByHand) {
  const Camera camera{600.0, 600.0, 320.0, 240.0, 640, 480};
  MotionProblem problem{{}, camera, camera, 0.5};
  RandomStream rng({.seed = 1, .purpose = 102});
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector2d x1(rng.Uniform(100.0, 500.0), rng.Uniform(50.0, 400.0));
    problem.matches.push_back({x1, x1 - Eigen::Vector2d(30.0, 0.0)});
  }
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.cam2_from_cam1 = {Eigen::Matrix3d::Identity(), -Eigen::Vector3d::UnitX()};
  estimate.pose_cov = Matrix5d::Identity() * 1e-6;
  const VisibleFeatures features = MeasureVisibleFeatures(problem, estimate);
  EXPECT_NEAR(At(features, VisibleFeature::kParallax), std::log(30.0 / (0.5 * std::sqrt(2.0))), 1e-9);
  EXPECT_DOUBLE_EQ(At(features, VisibleFeature::kPlanarity), std::log(61.0));
  EXPECT_NEAR(At(features, VisibleFeature::kRotation), std::log(0.1), 1e-9);
}

TEST(VisibleFeatures, PlanesLookMorePlanarThanScenesInDepth) {
  const std::unique_ptr<MotionEstimator> estimator = MakeEstimator("standard");
  const ProblemFamily deep("uniform_volume", "sideways", 100, 0.0), flat("plane", "sideways", 100, 0.0);
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    const auto planarity = [&](const ProblemFamily& family) {
      const MotionProblem problem = family.Make(trial);
      RandomStream rng({.seed = 1});
      return At(MeasureVisibleFeatures(problem, estimator->Estimate(problem, rng)),
                VisibleFeature::kPlanarity);
    };
    EXPECT_GT(planarity(flat), planarity(deep) + 1.0) << trial;
  }
}

TEST(VisibleFeatures, WithoutAMotionOnlyTheMatchesCount) {
  Exact exact = MakeExact(10);
  for (const auto spoil : {0, 1, 2}) {
    MotionEstimate estimate = exact.estimate;
    if (spoil == 0) estimate.status = MotionStatus::kNoCandidate;
    if (spoil == 1) estimate.pose_cov(0, 0) = kNaN;
    if (spoil == 2) estimate.inliers = {99};
    const VisibleFeatures features = MeasureVisibleFeatures(exact.made.problem, estimate);
    EXPECT_DOUBLE_EQ(features[0], std::log(11.0));
    for (size_t j = 1; j < kNumVisibleFeatures; ++j) EXPECT_TRUE(std::isnan(features[j])) << j;
  }
}

TEST(VisibleFeatures, EachHasAName) { EXPECT_EQ(VisibleFeatureNames().size(), kNumVisibleFeatures); }

}  // namespace
}  // namespace rcme
