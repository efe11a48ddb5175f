// What speaks against partners chosen at random: a known answer, its law where they are, and what it sees
// where they are not, under a small and under a large parallax.
#include "estimator/calibrated/partner_dependence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

PartnerDependence FindBothOfAll(const MotionProblem& problem, const RelativePose& pose) {
  std::vector<size_t> all(problem.matches.size());
  std::iota(all.begin(), all.end(), 0);
  return FindPartnerDependence(problem, pose, all);
}
double FindDependenceOfAll(const MotionProblem& problem, const RelativePose& pose) {
  return FindBothOfAll(problem, pose).greater_z();
}

// Cameras of one pixel per unit, the second a step to the right: a and b are x / sqrt(x^2 + 1) on the middle
// line, that of camera 1 with the opposite sign of the step's.
MotionProblem ProblemOnALine(const std::vector<std::pair<double, double>>& places) {
  const Camera camera{.fx = 1.0, .fy = 1.0, .cx = 0.0, .cy = 0.0, .width = 100, .height = 100};
  MotionProblem problem{{}, camera, camera, 0.01};
  for (const auto& [x1, x2] : places) problem.matches.push_back({{x1, 0.0}, {x2, 0.0}});
  return problem;
}
const RelativePose kStepToTheRight{Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitX()};

// Three matches that could all have each other's partner. In order: risk sets of 3, 2 and 1 with sums of
// signs 2, 1 and 0, variances 8/3, 3/3 and 0. Against the order: sums -2, -1, 0; then the ranks, a third of
// 5/6, 1/2 and 1/6, speak as little: 0.
TEST(FindPartnerDependence, IsThatOfThreeMatchesByHand) {
  EXPECT_NEAR(FindBothOfAll(ProblemOnALine({{-3, 3}, {-2, 2}, {-1, 1}}), kStepToTheRight).order_z,
              -3.0 / std::sqrt(11.0 / 3.0), 1e-12);
  EXPECT_NEAR(FindDependenceOfAll(ProblemOnALine({{-3, 1}, {-2, 2}, {-1, 3}}), kStepToTheRight),
              3.0 / std::sqrt(11.0 / 3.0), 1e-12);
  EXPECT_NEAR(FindDependenceOfAll(ProblemOnALine({{-3, 3}, {-2, 2}, {-1, 1}}), kStepToTheRight), 0.0, 1e-12);
}

// Next to each other in pairs: no match could have another's partner and keep its order, but of those that
// are greater, 4, 3, 2 and 1, its own is the first. Deviations of 3/8, 1/3 and 1/4, variances of (1 - 1/m^2)
// / 12.
TEST(FindPartnerDependence, IsThatOfFourNearestPartnersByHand) {
  const double variance = (3.0 - 1.0 / 16 - 1.0 / 9 - 1.0 / 4) / 12.0;
  EXPECT_NEAR(FindDependenceOfAll(ProblemOnALine({{1, 1.1}, {2, 2.1}, {3, 3.1}, {4, 4.1}}), kStepToTheRight),
              (3.0 / 8 + 1.0 / 3 + 1.0 / 4) / std::sqrt(variance), 1e-12);
}

TEST(FindPartnerDependence, IsNothingForNoMatchOrTheSameOne) {
  EXPECT_EQ(FindDependenceOfAll(ProblemOnALine({}), kStepToTheRight), 0.0);
  EXPECT_EQ(FindDependenceOfAll(ProblemOnALine({{1, 2}}), kStepToTheRight), 0.0);
  const std::vector<std::pair<double, double>> same(20, {1, 2});
  EXPECT_NEAR(FindDependenceOfAll(ProblemOnALine(same), kStepToTheRight), 0.0, 1e-12);
  EXPECT_EQ(FindDependenceOfAll(ProblemOnALine({{2, 1}, {3, 2}, {4, 3}}), kStepToTheRight),
            0.0);  // behind a camera
}

// Points of two images paired at random, of which those in front of both cameras are looked at. Each of the
// two tests is beyond 3 in .00135 of the scenes if it is normal: 2.7 of 1,000 are expected, more than 14 come
// once in a million runs; twice the variance would give 34.
TEST(FindPartnerDependence, IsSeldomLargeWherePartnersAreRandom) {
  int num_large = 0;
  double sum = 0.0;
  for (std::uint32_t trial = 0; trial < 1000; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2910});
    std::vector<std::pair<double, double>> places;
    std::vector<size_t> in_front;
    for (size_t i = 0; i < 80; ++i) {
      places.emplace_back(rng.Uniform(-0.5, 0.5), rng.Uniform(-0.5, 0.5));
      if (places[i].first < places[i].second) in_front.push_back(i);
    }
    const double z = FindPartnerDependence(ProblemOnALine(places), kStepToTheRight, in_front).greater_z();
    num_large += z > 3.0;
    sum += z;
  }
  EXPECT_LE(num_large, 14);
  EXPECT_NEAR(sum / 1000.0, 0.56, 0.25);  // the mean of the greater of two normal numbers, correlated or not
}

// Twenty matches of each of 100 scenes with noise.
TEST(FindPartnerDependence, IsLargeWhereTheyAreImagesOfPoints) {
  double sum = 0.0;
  for (std::uint32_t trial = 0; trial < 100; ++trial) {
    RelativePose pose_true;
    const MotionProblem problem = TwoCameraProblem(20, 0.5, 0.0, trial, &pose_true);
    const double z = FindDependenceOfAll(problem, pose_true);
    EXPECT_GT(z, 1.5) << trial;
    sum += z;
  }
  EXPECT_GT(sum / 100.0, 3.0);
}

// Points all around, seen from a side and a quarter of a circle on: half of the angles are larger than the
// spread of the scene in an image, so that no order is excluded, and ranks say nothing.
TEST(FindPartnerDependence, SeesAQuarterOfACircle) {
  const Camera camera{.fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0, .width = 640, .height = 480};
  const Eigen::Matrix3d R = RotationFromVector({0.0, 0.5 * M_PI, 0.0});
  const Eigen::Vector3d center(0.0, 0.0, 4.0);
  const Eigen::Vector3d t = center - R * center;
  for (std::uint32_t trial = 0; trial < 100; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2911});
    MotionProblem problem{{}, camera, camera, 0.5};
    for (int i = 0; i < 60; ++i) {
      // A wall that both see at 45 deg.
      const double along = rng.Uniform(-1.0, 1.0);
      const Eigen::Vector3d point =
          center + Eigen::Vector3d(along, rng.Uniform(-1.0, 1.0), along + rng.Uniform(-0.2, 0.2));
      problem.matches.push_back({camera.Project(point), camera.Project(R * point + t)});
    }
    EXPECT_GT(FindDependenceOfAll(problem, {R, t.normalized()}), 3.0) << trial;
  }
}

}  // namespace
}  // namespace rcme
