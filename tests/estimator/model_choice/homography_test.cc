#include "estimator/model_choice/homography.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/refinement/rotation_equations.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "tests/test_support/family_problem.h"
#include "tests/test_support/linear_algebra.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

constexpr double kThreshold = 13.8;

// Matches of a plane across the view, n.X = 6 baselines, without noise.
struct PlaneCase {
  RayMatches rays{{{}, TestCamera1(), TestCamera2(), 0.5}};
  Eigen::Matrix3d H_true;
};
PlaneCase MakePlaneCase(int num_matches, RandomStream& rng) {
  PlaneCase plane;
  const RelativePose pose = RandomPose(rng, 10.0);
  const Eigen::Vector3d m = (Eigen::Vector3d::UnitZ() + 0.3 * RandomDirection(rng)) / 6.0;
  plane.H_true = pose.R + pose.t * m.transpose();
  plane.H_true /= plane.H_true.norm();
  while (static_cast<int>(plane.rays.matches.size()) < num_matches) {
    const Eigen::Vector3d ray1(rng.Uniform(-0.4, 0.4), rng.Uniform(-0.3, 0.3), 1.0);
    const Eigen::Vector3d in_cam2 = pose.R * (ray1 / m.dot(ray1)) + pose.t;
    plane.rays.matches.push_back({ray1, in_cam2 / in_cam2.z()});
  }
  return plane;
}

FourMatches FirstFour(const PlaneCase& plane) {
  const auto& m = plane.rays.matches;
  return {m[0], m[1], m[2], m[3]};
}

// The direct linear transform: two rows of ray2 x (H ray1) = 0 for each match, null vector by SVD.
Eigen::Matrix3d DirectLinearTransform(const FourMatches& sample) {
  Eigen::MatrixXd rows(8, 9);
  for (int k = 0; k < 4; ++k) {
    const RayMatch& match = sample[static_cast<size_t>(k)];
    const Eigen::RowVector3d x1 = match.ray1.transpose(), zero = Eigen::RowVector3d::Zero();
    rows.row(2 * k) << zero, -x1, match.ray2.y() * x1;
    rows.row(2 * k + 1) << x1, zero, -match.ray2.x() * x1;
  }
  const Eigen::Matrix3d H = Matricize(NullSpace(rows).col(0));
  return (H * sample[0].ray1).z() > 0.0 ? H : Eigen::Matrix3d(-H);
}

TEST(HomographyOfFour, IsThePlanesAndTheDirectLinearTransforms) {
  RandomStream rng({.seed = 1, .purpose = 2751});
  int num_well_spread = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const PlaneCase plane = MakePlaneCase(4, rng);
    FourMatches sample = FirstFour(plane);
    const std::optional<Eigen::Matrix3d> exact = HomographyOfFour(sample);
    ASSERT_TRUE(exact.has_value());
    Eigen::Matrix3d three;
    three << sample[0].ray1, sample[1].ray1, sample[2].ray1;
    const bool is_well_spread = SingularValues(three)(2) > 0.02;
    if (is_well_spread) {
      ++num_well_spread;
      EXPECT_LT((*exact - plane.H_true).norm(), 1e-9);
    }
    for (RayMatch& match : sample)
      match.ray2.head<2>() += 0.001 * Eigen::Vector2d(rng.Normal(), rng.Normal());
    const std::optional<Eigen::Matrix3d> noisy = HomographyOfFour(sample);
    if (!noisy) continue;  // noise may turn a thin triangle over
    for (const RayMatch& match : sample) {
      EXPECT_LT(((*noisy * match.ray1).hnormalized() - match.ray2.head<2>()).norm(), 1e-7);
    }
    if (is_well_spread) {
      EXPECT_LT((*noisy - DirectLinearTransform(sample)).norm(), 1e-7);
    }
  }
  EXPECT_GT(num_well_spread, 100);
}

TEST(HomographyOfFour, ThreePointsOnALineDetermineNone) {
  RandomStream rng({.seed = 1, .purpose = 2752});
  const FourMatches good = FirstFour(MakePlaneCase(4, rng));
  ASSERT_TRUE(HomographyOfFour(good).has_value());
  for (int left_out = 0; left_out < 4; ++left_out) {
    FourMatches sample = good;
    for (int k = 0; k < 4; ++k) {
      if (k != left_out) sample[static_cast<size_t>(k)].ray1 << 0.1 * k, 0.2 - 0.05 * k, 1.0;
    }
    EXPECT_FALSE(HomographyOfFour(sample).has_value()) << left_out;
  }
  FourMatches repeated = good;
  repeated[3] = repeated[1];
  EXPECT_FALSE(HomographyOfFour(repeated).has_value());
}

// A triangle that one image shows from the other side than the second: no plane in front of both cameras.
TEST(HomographyOfFour, PointsBehindACameraDetermineNone) {
  const Eigen::Vector3d a(0, 0, 1), b(1, 0, 1), c(0, 1, 1), outside(1, 1, 1), inside(0.3, 0.3, 1);
  EXPECT_TRUE(HomographyOfFour({{{a, a}, {b, b}, {c, c}, {outside, outside}}}).has_value());
  EXPECT_FALSE(HomographyOfFour({{{a, a}, {b, b}, {c, c}, {outside, inside}}}).has_value());
}

TEST(RotationOfTwo, IsTheRotation) {
  RandomStream rng({.seed = 1, .purpose = 2753});
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Matrix3d R = RandomPose(rng, 30.0).R;
    TwoMatches sample;
    for (RayMatch& match : sample) {
      match.ray1 << rng.Uniform(-0.4, 0.4), rng.Uniform(-0.3, 0.3), 1.0;
      match.ray2 = R * match.ray1;
      match.ray2 /= match.ray2.z();
    }
    const std::optional<Eigen::Matrix3d> found = RotationOfTwo(sample);
    ASSERT_TRUE(found.has_value());
    EXPECT_LT((*found - R).norm(), 1e-9);
    EXPECT_FALSE(RotationOfTwo({sample[0], sample[0]}).has_value());
  }
}

// By central differences, in pixels: nothing of the code's.
double SquaredTransferInPixels(const MotionProblem& p, const Eigen::Matrix3d& H,
                               const Correspondence& match) {
  const auto transfer = [&](const Eigen::Vector2d& x1) { return p.camera2.Project(H * p.camera1.Ray(x1)); };
  Eigen::Matrix2d J;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d h = 1e-3 * Eigen::Vector2d::Unit(i);
    J.col(i) = (transfer(match.x1_px + h) - transfer(match.x1_px - h)) / 2e-3;
  }
  const Eigen::Vector2d e = match.x2_px - transfer(match.x1_px);
  const Eigen::Matrix2d C = p.sigma_px * p.sigma_px * (Eigen::Matrix2d::Identity() + J * J.transpose());
  return e.dot(C.inverse() * e);
}

TEST(EvaluateTransfer, IsItsDefinitionAndThatOfARotation) {
  RandomStream rng({.seed = 1, .purpose = 2754});
  for (int trial = 0; trial < 20; ++trial) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 20});
    AddNoise(0.5, rng, &random.problem);
    const RayMatches rays(random.problem);
    const Eigen::Matrix3d H = MakePlaneCase(4, rng).H_true;
    const std::vector<double> squared = SquaredTransfers(rays, H);
    const std::vector<double> rotated = SquaredTransfers(rays, random.pose_true.R);
    for (int i = 0; i < 20; ++i) {
      const auto k = static_cast<size_t>(i);
      const double expected = SquaredTransferInPixels(random.problem, H, random.problem.matches[k]);
      EXPECT_NEAR(squared[k], expected, 1e-5 * expected);
      const int index[] = {i};
      const double energy =
          LinearizeRotation(random.problem, index, random.pose_true.R, Loss::kSquared).energy;
      EXPECT_NEAR(rotated[k], energy, 1e-9 * energy);
    }
  }
}

TEST(EvaluateTransfer, BehindCamera2ThereIsNone) {
  const RayScale noise{1e-3, 1e-3, 1e-3, 1e-3};
  const RayMatch match{{0.1, 0.2, 1.0}, {0.1, 0.2, 1.0}};
  EXPECT_TRUE(EvaluateTransfer(Eigen::Matrix3d::Identity(), match, noise).has_value());
  EXPECT_FALSE(EvaluateTransfer(-Eigen::Matrix3d::Identity(), match, noise).has_value());
  EXPECT_FALSE(EvaluateTransfer(Eigen::Matrix3d::Zero(), match, noise).has_value());
  EXPECT_FALSE(
      EvaluateTransfer(std::numeric_limits<double>::quiet_NaN() * Eigen::Matrix3d::Identity(), match, noise)
          .has_value());
}

TEST(TruncatedCost, CountsNoMatchBeyondTheThresholdAndStopsEarly) {
  RandomStream rng({.seed = 1, .purpose = 2755});
  PlaneCase plane = MakePlaneCase(10, rng);
  plane.rays.matches[4].ray2.x() += 1.0;
  EXPECT_NEAR(TruncatedCost(plane.rays, plane.H_true, 9.0, kInfinity), 9.0, 1e-9);
  EXPECT_NEAR(TruncatedCost(plane.rays, -plane.H_true, 9.0, kInfinity), 90.0, 1e-9);
  EXPECT_NEAR(TruncatedCost(plane.rays, -plane.H_true, 9.0, 20.0), 27.0, 1e-9);
}

// The sum of d2 at the optimum is chi-square with 2n - 8 degrees of freedom: its mean over 200 trials lies
// within four standard errors but once in 16,000. At the homography of a sample, or with a wrong covariance,
// it does not.
TEST(RefineHomography, LeavesTheResidualsOfALeastSquaresFit) {
  constexpr int kNumTrials = 200, kNumMatches = 60;
  RandomStream rng({.seed = 1, .purpose = 2756});
  double refined = 0.0, of_truth = 0.0;
  for (int trial = 0; trial < kNumTrials; ++trial) {
    PlaneCase plane = MakePlaneCase(kNumMatches, rng);
    const RayScale& s = plane.rays.noise;
    for (RayMatch& match : plane.rays.matches) {
      match.ray1.head<2>() += Eigen::Vector2d(s.x1 * rng.Normal(), s.y1 * rng.Normal());
      match.ray2.head<2>() += Eigen::Vector2d(s.x2 * rng.Normal(), s.y2 * rng.Normal());
    }
    const Eigen::Matrix3d H = RefineHomography(plane.rays, plane.H_true, 1e3);
    refined += TruncatedCost(plane.rays, H, kInfinity, kInfinity);
    of_truth += TruncatedCost(plane.rays, plane.H_true, kInfinity, kInfinity);
  }
  const auto tolerance = [](double dof) { return 4.0 * std::sqrt(2.0 * dof / kNumTrials); };
  EXPECT_NEAR(refined / kNumTrials, 2 * kNumMatches - 8, tolerance(2 * kNumMatches - 8));
  EXPECT_NEAR(of_truth / kNumTrials, 2 * kNumMatches, tolerance(2 * kNumMatches));
}

TEST(RefineHomography, NeverRaisesTheCost) {
  const ProblemFamily family("plane_and_parallax", "general", 100, 0.3);
  RandomStream rng({.seed = 1, .purpose = 2757});
  int num_lower = 0;
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    const RayMatches rays(family.Make(trial));
    FourMatches sample;
    for (RayMatch& match : sample) match = rays.matches[rng.IntegerBelow(100)];
    const std::optional<Eigen::Matrix3d> start = HomographyOfFour(sample);
    if (!start) continue;
    const double before = TruncatedCost(rays, *start, kThreshold, kInfinity);
    const double after =
        TruncatedCost(rays, RefineHomography(rays, *start, kThreshold), kThreshold, kInfinity);
    EXPECT_LE(after, before);
    num_lower += after < before;
  }
  EXPECT_GT(num_lower, 5);
}

}  // namespace
}  // namespace rcme
