#include "experiments/real/truth_free/halves.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "stats/median_ratio.h"
#include "tests/test_support/fit_all_matches.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// Fits every problem from the truth, and keeps what it was given.
class FitsHalves : public MotionEstimator {
 public:
  explicit FitsHalves(const RelativePose& start) : start_(start) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream&) const override {
    given_.push_back(problem.matches);
    answers_.push_back(FitAllMatches(problem, start_));
    return answers_.back();
  }
  const std::vector<std::vector<Correspondence>>& given() const { return given_; }
  const std::vector<MotionEstimate>& answers() const { return answers_; }

 private:
  RelativePose start_;
  mutable std::vector<std::vector<Correspondence>> given_;
  mutable std::vector<MotionEstimate> answers_;
};

constexpr StreamName kName = {1, 2, 3, 0};

// Same directions: the plain form with the sum of both covariances.
TEST(NormalizedDifference, OfTwoMotionsByHand) {
  MotionEstimate a, b;
  a.cam2_from_cam1 = {Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitZ()};
  b.cam2_from_cam1 = {RotationFromVector({0.01, 0.0, 0.0}), Eigen::Vector3d::UnitZ()};
  a.pose_cov = 1e-4 * Matrix5d::Identity();
  b.pose_cov = 3e-4 * Matrix5d::Identity();
  EXPECT_NEAR(NormalizedDifference(a, b), 1e-4 / 4e-4, 1e-9);
}

// Directions far apart, whose tangents have other bases: the covariance of b, much wider along one of its
// axes, is turned into the basis at a.
TEST(NormalizedDifference, BringsTheTangentsTogether) {
  MotionEstimate a, b;
  a.cam2_from_cam1 = {Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.2, 0.3, 0.9).normalized()};
  b.cam2_from_cam1 = {Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.9, -0.4, 0.1).normalized()};
  Vector5d variances = Vector5d::Constant(1e-4);
  a.pose_cov = variances.asDiagonal();
  variances(4) = 0.25;
  b.pose_cov = variances.asDiagonal();
  const Eigen::Vector3d wide_axis = DirectionBasis(b.cam2_from_cam1.t).col(1),
                        other_axis = DirectionBasis(b.cam2_from_cam1.t).col(0);
  const Eigen::Matrix3d in_space =
      1e-4 * other_axis * other_axis.transpose() + 0.25 * wide_axis * wide_axis.transpose();
  const Eigen::Matrix<double, 3, 2> basis = DirectionBasis(a.cam2_from_cam1.t);
  const Eigen::Matrix2d sum = 1e-4 * Eigen::Matrix2d::Identity() + basis.transpose() * in_space * basis;
  const Eigen::Vector2d away = LocalCoordinates(a.cam2_from_cam1, b.cam2_from_cam1).tail<2>();
  EXPECT_NEAR(NormalizedDifference(a, b), away.dot(sum.inverse() * away), 1e-6 * NormalizedDifference(a, b));
}

// Every match is in one half; halves of an image are parted at the median of the inliers, along x or y, and
// random ones are of equal number.
TEST(DifferenceOfHalves, PartsTheMatches) {
  RelativePose pose;
  const MotionProblem problem = TwoCameraProblem(121, 0.5, 0.0, 1, &pose);
  const MotionEstimate whole = FitAllMatches(problem, pose);
  for (const Split split : {Split::kLeftRight, Split::kUpperLower, Split::kRandom, Split::kRandomAgain}) {
    const FitsHalves estimator(pose);
    const std::optional<double> difference = DifferenceOfHalves(problem, whole, split, estimator, kName);
    ASSERT_TRUE(difference.has_value());
    ASSERT_EQ(estimator.given().size(), 2u);
    const std::vector<Correspondence>&first = estimator.given()[0], &second = estimator.given()[1];
    EXPECT_EQ(first.size() + second.size(), 121u);
    EXPECT_EQ(first.size(), 60u);
    for (const Correspondence& match : first) {
      EXPECT_EQ(std::ranges::count(second, match.x1_px, &Correspondence::x1_px), 0);
    }
    EXPECT_EQ(*difference, NormalizedDifference(estimator.answers()[0], estimator.answers()[1]));
    if (split != Split::kLeftRight && split != Split::kUpperLower) continue;
    const Eigen::Index axis = split == Split::kLeftRight ? 0 : 1;
    std::vector<double> places;
    for (const Correspondence& match : problem.matches) places.push_back(match.x1_px(axis));
    const double border_px = ComputeMedian(places);
    for (const Correspondence& match : first) EXPECT_LT(match.x1_px(axis), border_px);
    for (const Correspondence& match : second) EXPECT_GE(match.x1_px(axis), border_px);
  }
}

TEST(DifferenceOfHalves, NeedsTwentyMatchesInEach) {
  RelativePose pose;
  for (const int n : {39, 40}) {
    const MotionProblem problem = TwoCameraProblem(n, 0.5, 0.0, 1, &pose);
    const bool is_there =
        DifferenceOfHalves(problem, FitAllMatches(problem, pose), Split::kRandom, FitsHalves(pose), kName)
            .has_value();
    EXPECT_EQ(is_there, n == 40);
  }
}

// Halves of independent errors: of 200 the mean of the normalised differences is 5 (chi-square, dof 5) within
// 3.9 standard errors and what covariances of 100 matches are uncertain by, 5 %. One covariance alone for the
// sum would double it.
TEST(DifferenceOfHalves, IsChiSquareOfIndependentErrors) {
  double sum = 0.0;
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    RelativePose pose;
    const MotionProblem problem = TwoCameraProblem(200, 0.5, 0.0, trial, &pose);
    sum += *DifferenceOfHalves(problem, FitAllMatches(problem, pose), Split::kRandom, FitsHalves(pose),
                               {1, 2, trial, 0});
  }
  EXPECT_NEAR(sum / 200.0, 5.0, 3.9 * std::sqrt(10.0 / 200.0) + 0.25);
}

}  // namespace
}  // namespace rcme
