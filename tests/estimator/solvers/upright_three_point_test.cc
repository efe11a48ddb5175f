#include "estimator/solvers/upright_three_point.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/solvers/five_point.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

// Matches as rays, with gravity in both cameras.
struct UprightRays {
  UprightThreePoint::Rays first, second;
  Eigen::Vector3d gravity1, gravity2;
};

UprightRays TakeUprightRays(const MotionProblem& problem, const RelativePose& pose, RandomStream& rng) {
  UprightRays rays;
  for (size_t k = 0; k < 3; ++k) {
    rays.first[k] = problem.camera1.Ray(problem.matches[k].x1_px);
    rays.second[k] = problem.camera2.Ray(problem.matches[k].x2_px);
  }
  rays.gravity1 = RandomDirection(rng);
  rays.gravity2 = pose.R * rays.gravity1;
  return rays;
}

std::vector<Eigen::Matrix3d> SolveUpright(const UprightRays& rays) {
  const auto found = UprightThreePoint(rays.gravity1, rays.gravity2).Solve(rays.first, rays.second);
  return {found.E.begin(), found.E.begin() + found.count};
}

// How far E is from the nearest of `others`, either sign; 2, further than any can be, if there is none.
double DistanceToNearestUpright(const Eigen::Matrix3d& E, const std::vector<Eigen::Matrix3d>& others) {
  double nearest = 2.0;
  for (const Eigen::Matrix3d& other : others)
    nearest = std::min({nearest, (E - other).norm(), (E + other).norm()});
  return nearest;
}

// How far the better of the two rotations of E is from turning gravity1 to gravity2.
double GravityMisfit(const Eigen::Matrix3d& E, const Eigen::Vector3d& gravity1,
                     const Eigen::Vector3d& gravity2) {
  double misfit = 2.0;
  for (const RelativePose& pose : PosesFromEssential(ProjectToEssential(E)))
    misfit = std::min(misfit, (pose.R * gravity1 - gravity2).norm());
  return misfit;
}

constexpr RandomProblemOptions kThreeMatches = {.num_matches = 3, .max_rotation_deg = 40.0};

TEST(UprightThreePoint, EverySolutionMeetsTheConstraints) {
  RandomStream rng({.seed = 1, .purpose = 4180});
  int num_solutions = 0;
  for (int i = 0; i < 2000; ++i) {
    RandomProblem random = MakeRandomProblem(rng, kThreeMatches);
    AddNoise(0.5, rng, &random.problem);
    UprightRays rays = TakeUprightRays(random.problem, random.pose_true, rng);
    rays.gravity2 = (rays.gravity2 + 0.03 * RandomDirection(rng)).normalized();
    for (const Eigen::Matrix3d& E : SolveUpright(rays)) {
      ++num_solutions;
      for (size_t k = 0; k < 3; ++k) {
        EXPECT_LT(std::abs(rays.second[k].normalized().dot(E * rays.first[k].normalized())), 1e-8);
      }
      EXPECT_NEAR(E.squaredNorm(), 2.0, 1e-12);
      EXPECT_LT((E * E.transpose() * E - E).norm(), 1e-12);  // singular values 1, 1, 0
      EXPECT_LT(GravityMisfit(E, rays.gravity1, rays.gravity2), 1e-10);
    }
  }
  EXPECT_GT(num_solutions, 2 * 2000);
}

TEST(UprightThreePoint, TheTruthIsAmongTheSolutionsOfExactMatches) {
  RandomStream rng({.seed = 1, .purpose = 4181});
  std::vector<double> distances;
  for (int i = 0; i < 5000; ++i) {
    const RandomProblem random = MakeRandomProblem(rng, kThreeMatches);
    distances.push_back(
        DistanceToNearestUpright(EssentialFromPose(random.pose_true),
                                 SolveUpright(TakeUprightRays(random.problem, random.pose_true, rng))));
  }
  std::sort(distances.begin(), distances.end());
  RecordProperty("median", testing::PrintToString(distances[2500]));
  RecordProperty("quantile_0.99", testing::PrintToString(distances[4950]));
  RecordProperty("quantile_0.999", testing::PrintToString(distances[4995]));
  RecordProperty("largest", testing::PrintToString(distances.back()));
  EXPECT_LT(distances[2500], 1e-11);
  EXPECT_LT(distances[4950], 1e-8);
}

// The determinant whose zeros the solver looks for, from rotations about gravity in place of the polynomial.
double DeterminantAt(double theta, const Eigen::Matrix3d& R_start, const UprightRays& rays) {
  const Eigen::Matrix3d R = RotationFromVector(theta * rays.gravity2) * R_start;
  Eigen::Matrix3d n;
  for (size_t k = 0; k < 3; ++k)
    n.col(static_cast<int>(k)) = (R * rays.first[k].normalized()).cross(rays.second[k].normalized());
  return n.determinant();
}

// Turns by any angle about gravity, as of a camera that looks down; rays in all directions. Neighbouring
// zeros closer than the steps are not counted.
TEST(UprightThreePoint, FindsEveryZeroOfTheDeterminant) {
  RandomStream rng({.seed = 1, .purpose = 4182});
  constexpr int kSteps = 2000;
  CoverageCount equal;
  int largest = 0;
  for (int i = 0; i < 500; ++i) {
    UprightRays rays;
    for (size_t k = 0; k < 3; ++k) {
      rays.first[k] = RandomDirection(rng);
      rays.second[k] = RandomDirection(rng);
    }
    const Eigen::Matrix3d R = RandomPose(rng, 180.0).R;
    rays.gravity1 = RandomDirection(rng);
    rays.gravity2 = R * rays.gravity1;
    int num_changes = 0;
    double last = DeterminantAt(0.0, R, rays);
    for (int step = 1; step <= kSteps; ++step) {
      const double now = DeterminantAt(2.0 * std::numbers::pi * step / kSteps, R, rays);
      num_changes += (now < 0.0) != (last < 0.0);
      last = now;
    }
    const int count = static_cast<int>(SolveUpright(rays).size());
    EXPECT_GE(count, num_changes) << i;
    equal.Add(count == num_changes);
    largest = std::max(largest, count);
  }
  EXPECT_EQ(largest, 4);
  EXPECT_GT(equal.rate(), 0.98) << equal;
}

TEST(UprightThreePoint, ATurnByAnyAngleAboutGravityIsFound) {
  RandomStream rng({.seed = 1, .purpose = 4183});
  std::vector<double> distances;
  for (int i = 0; i < 360; ++i) {
    RelativePose pose = RandomPose(rng, 30.0);
    UprightRays rays;
    rays.gravity2 = RandomDirection(rng);
    rays.gravity1 = pose.R.transpose() * rays.gravity2;
    pose.R = RotationFromVector(i * std::numbers::pi / 180.0 * rays.gravity2) * pose.R;
    for (size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d point = rng.Uniform(2.0, 8.0) * RandomDirection(rng);
      rays.first[k] = point;
      rays.second[k] = pose.R * point + pose.t;
    }
    distances.push_back(DistanceToNearestUpright(EssentialFromPose(pose), SolveUpright(rays)));
  }
  std::sort(distances.begin(), distances.end());
  EXPECT_LT(distances[180], 1e-13);
  EXPECT_LT(distances.back(), 1e-6);
}

// The essential matrices of five matches that agree with gravity are those of three that fit the other two.
TEST(UprightThreePoint, AgreesWithFivePointsOnExactMatches) {
  RandomStream rng({.seed = 1, .purpose = 4184});
  constexpr double kSmall = 1e-6;
  int num_compared = 0;
  for (int i = 0; i < 1000; ++i) {
    const RandomProblem random = MakeRandomProblem(rng, {.num_matches = 5, .max_rotation_deg = 40.0});
    const UprightRays rays = TakeUprightRays(random.problem, random.pose_true, rng);
    FivePoint::Rays first, second;
    for (size_t k = 0; k < 5; ++k) {
      first[k] = random.problem.camera1.Ray(random.problem.matches[k].x1_px);
      second[k] = random.problem.camera2.Ray(random.problem.matches[k].x2_px);
    }
    std::vector<Eigen::Matrix3d> of_three, of_five;
    for (const Eigen::Matrix3d& E : SolveUpright(rays)) {
      const bool fits = std::abs(second[3].dot(E * first[3])) < 1e-2 * kSmall &&
                        std::abs(second[4].dot(E * first[4])) < 1e-2 * kSmall;
      if (fits) of_three.push_back(E);
    }
    const FivePoint::Solutions solutions = FivePoint::Solve(first, second);
    for (int k = 0; k < solutions.count; ++k) {
      const Eigen::Matrix3d& E = solutions.E[static_cast<size_t>(k)];
      if (GravityMisfit(E, rays.gravity1, rays.gravity2) < kSmall) of_five.push_back(E);
    }
    if (of_three.size() != 1 || of_five.size() != 1) continue;
    ++num_compared;
    EXPECT_LT(DistanceToNearestUpright(of_three[0], of_five), 1e-4) << i;
  }
  EXPECT_GT(num_compared, 980);
}

TEST(UprightThreePoint, LengthsAndOrderOfTheRaysDoNotMatter) {
  RandomStream rng({.seed = 1, .purpose = 4185});
  for (int i = 0; i < 100; ++i) {
    RandomProblem random = MakeRandomProblem(rng, kThreeMatches);
    AddNoise(0.5, rng, &random.problem);
    const UprightRays rays = TakeUprightRays(random.problem, random.pose_true, rng);
    UprightRays other = rays;
    for (size_t k = 0; k < 3; ++k) {
      other.first[k] = rng.Uniform(0.01, 100.0) * rays.first[2 - k];
      other.second[k] = -rng.Uniform(0.01, 100.0) * rays.second[2 - k];
    }
    const std::vector<Eigen::Matrix3d> expected = SolveUpright(rays), found = SolveUpright(other);
    ASSERT_EQ(found.size(), expected.size());
    for (const Eigen::Matrix3d& E : found) EXPECT_LT(DistanceToNearestUpright(E, expected), 1e-5);
  }
}

TEST(UprightThreePoint, ARepeatedMatchIsDegenerate) {
  RandomStream rng({.seed = 1, .purpose = 4186});
  for (int i = 0; i < 200; ++i) {
    RandomProblem random = MakeRandomProblem(rng, kThreeMatches);
    AddNoise(1.0, rng, &random.problem);
    UprightRays rays = TakeUprightRays(random.problem, random.pose_true, rng);
    // of other lengths, so that their directions are equal up to rounding only
    rays.first[2] = rng.Uniform(1.0, 3.0) * rays.first[0];
    rays.second[2] = rng.Uniform(1.0, 3.0) * rays.second[0];
    EXPECT_TRUE(SolveUpright(rays).empty());
  }
}

// All directions of translation fit a pure rotation. Rounding leaves solutions near its triple root: finite,
// with the right rotation.
TEST(UprightThreePoint, SolutionsOfAPureRotationAreFinite) {
  RandomStream rng({.seed = 1, .purpose = 4187});
  for (int i = 0; i < 300; ++i) {
    const RandomProblem random = MakeRandomProblem(rng, kThreeMatches);
    UprightRays rays = TakeUprightRays(random.problem, random.pose_true, rng);
    for (size_t k = 0; k < 3; ++k) rays.second[k] = random.pose_true.R * rays.first[k];
    for (const Eigen::Matrix3d& E : SolveUpright(rays)) {
      ASSERT_TRUE(E.allFinite());
      EXPECT_NEAR(E.squaredNorm(), 2.0, 1e-9);
    }
  }
}

TEST(UprightThreePoint, BadNumbersGiveNoSolution) {
  RandomStream rng({.seed = 1, .purpose = 4188});
  const RandomProblem random = MakeRandomProblem(rng, kThreeMatches);
  const UprightRays good = TakeUprightRays(random.problem, random.pose_true, rng);
  ASSERT_FALSE(SolveUpright(good).empty());
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::max()}) {
    UprightRays rays = good;
    rays.second[1].y() = bad;
    EXPECT_TRUE(SolveUpright(rays).empty()) << bad;
    rays = good;
    rays.gravity1.x() = bad;
    EXPECT_TRUE(SolveUpright(rays).empty()) << bad;
  }
  UprightRays rays = good;
  rays.first[2].setZero();
  EXPECT_TRUE(SolveUpright(rays).empty());
}

}  // namespace
}  // namespace rcme
