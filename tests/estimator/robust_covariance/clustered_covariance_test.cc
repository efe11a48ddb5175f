// Groups of matches, and what a motion's residuals and their derivatives are.
#include "estimator/robust_covariance/clustered_covariance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "estimator/geometry/sampson.h"
#include "stats/random.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

Eigen::Matrix3d ComputeFundamental(const MotionProblem& problem, const RelativePose& pose) {
  return FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2);
}

// Residuals g / (sigma w |J|) of matches whose noise is w sigma, their derivatives along the motion (of g,
// the gradient held) by differences, and normals of length one; a factor forgotten changes any of them.
TEST(ScoreFitted, IsThatOfTheConstraintByDifferences) {
  RelativePose pose;
  MotionProblem problem = TwoCameraProblem(12, 0.5, 0.0, 1, &pose);
  for (size_t i = 0; i < 12; ++i) problem.noise_scale.push_back(0.5 + 0.25 * static_cast<double>(i));
  const std::vector<int> fitted = {1, 4, 11};
  const MatchScores scores = ScoreFitted(problem, fitted, pose);
  ASSERT_EQ(scores.residuals.size(), 3u);
  const Eigen::Matrix3d F = ComputeFundamental(problem, pose);
  Matrix5d information = Matrix5d::Zero();
  for (size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<size_t>(fitted[k]);
    const Correspondence& match = problem.matches[i];
    const EpipolarConstraint c = EvaluateConstraint(F, match);
    const double unit = 0.5 * problem.noise_scale[i] * c.gradient.norm();
    EXPECT_EQ(scores.matches[k].x1_px, match.x1_px);
    EXPECT_NEAR(std::abs(scores.residuals[k]), std::abs(c.g) / unit, 1e-9);
    EXPECT_NEAR(scores.normals[k].norm(), 1.0, 1e-12);
    EXPECT_NEAR(std::abs(scores.normals[k].dot(c.gradient)), c.gradient.norm(), 1e-9 * c.gradient.norm());
    const double sign = scores.residuals[k] * c.g > 0.0 ? 1.0 : -1.0;
    for (Eigen::Index j = 0; j < 5; ++j) {
      const auto g_at = [&](double by) {
        return EvaluateConstraint(ComputeFundamental(problem, Retract(pose, by * Vector5d::Unit(j))), match)
            .g;
      };
      const double slope = sign * (g_at(1e-6) - g_at(-1e-6)) / 2e-6 / unit;
      EXPECT_NEAR(scores.rows[k](j), slope, 1e-5 * (1.0 + std::abs(slope))) << k << " " << j;
    }
    information += scores.rows[k] * scores.rows[k].transpose();
  }
  EXPECT_LT((scores.information - information).norm(), 1e-9 * information.norm());
}

// Of one direction that a single match alone holds, 0.05 is taken to be held by the others: the part of a
// match with the leverage h is (r / max(1 - h, 0.05))^2.
TEST(ClusteredCovariance, KeepsATwentiethOfTheInformation) {
  MatchScores scores;
  const double leverage = 0.99;
  for (int k = 0; k < 5; ++k) {
    for (const double part : {leverage, 1.0 - leverage}) {
      scores.rows.emplace_back(std::sqrt(part) * Vector5d::Unit(k));
      scores.residuals.push_back(part == leverage ? 1.0 : 0.0);
    }
  }
  scores.information.setIdentity();
  const Matrix5d covariance = ClusteredCovariance(scores, Separate(10));
  EXPECT_LT((covariance - leverage / (0.05 * 0.05) * Matrix5d::Identity()).norm(), 1e-9 * covariance.norm());
  // Two that are a group hold all of it, and keep as much.
  const std::vector<int> pairs = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4};
  const Matrix5d of_pairs = ClusteredCovariance(scores, pairs);
  EXPECT_LT((of_pairs - covariance).norm(), 1e-9 * covariance.norm());
}

// Points in neighbouring cells of the grid are of one key point only within the radius, in either image.
TEST(KeyPointGroups, OfNeighbouringCellsAreThoseWithinTheRadius) {
  const auto at = [](double x1, double x2) { return Correspondence{{x1, 0.5}, {x2, 0.5}}; };
  EXPECT_EQ(KeyPointGroups({at(0.1, 0.0), at(1.05, 50.0)}, 1.0), (std::vector<int>{0, 0}));
  EXPECT_EQ(KeyPointGroups({at(0.1, 0.0), at(1.15, 50.0)}, 1.0), (std::vector<int>{0, 1}));
  EXPECT_EQ(KeyPointGroups({at(0.0, 0.1), at(50.0, 1.15)}, 1.0), (std::vector<int>{0, 1}));
  EXPECT_EQ(KeyPointGroups({at(0.0, 0.1), at(50.0, 1.05)}, 1.0), (std::vector<int>{0, 0}));
  EXPECT_EQ(KeyPointGroups({at(0.0, 0.1), at(50.0, 1.05)}, 0.5), (std::vector<int>{0, 1}));
}

// Sets of points by labels that are written anew wherever two points are within the radius.
std::vector<int> GroupByHand(const std::vector<Correspondence>& matches, double radius_px) {
  std::vector<int> label = Separate(matches.size());
  for (size_t i = 0; i < matches.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      if ((matches[i].x1_px - matches[k].x1_px).norm() > radius_px &&
          (matches[i].x2_px - matches[k].x2_px).norm() > radius_px)
        continue;
      const int from = std::max(label[i], label[k]), to = std::min(label[i], label[k]);
      std::ranges::replace(label, from, to);
    }
  }
  std::vector<int> numbers, firsts;
  for (const int first : label) {
    const auto found = std::ranges::find(firsts, first);
    numbers.push_back(static_cast<int>(found - firsts.begin()));
    if (found == firsts.end()) firsts.push_back(first);
  }
  return numbers;
}

// Sparse and dense images, on both sides of zero.
TEST(KeyPointGroups, AreThoseOfAllPairs) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 75});
    const double width_px = 6.0 + 2.0 * trial, radius_px = rng.Uniform(0.3, 1.5);
    std::vector<Correspondence> matches(100);
    for (Correspondence& match : matches) {
      for (double* x : {&match.x1_px.x(), &match.x1_px.y(), &match.x2_px.x(), &match.x2_px.y()})
        *x = width_px * (rng.Uniform() - 0.5);
    }
    EXPECT_EQ(KeyPointGroups(matches, radius_px), GroupByHand(matches, radius_px)) << trial;
  }
}

}  // namespace
}  // namespace rcme
