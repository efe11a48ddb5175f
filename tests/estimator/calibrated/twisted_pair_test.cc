#include "estimator/calibrated/twisted_pair.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/triangulation.h"
#include "tests/test_support/linear_algebra.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

constexpr double kTwistedSigmaPx = 0.5;

// Matches of points within `thickness` (share of the depth) of a plane that is seen obliquely.
struct PlaneCase {
  RandomProblem random;
  Eigen::Vector3d plane;  // n'X = 1, baselines^-1
};
PlaneCase MakePlane(std::uint32_t trial, double thickness, double sigma_px = kTwistedSigmaPx) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2730});
  PlaneCase c;
  c.random = MakeRandomProblem(rng, {.num_matches = 120});
  c.plane = Eigen::Vector3d(rng.Uniform(-0.1, 0.1), rng.Uniform(-0.1, 0.1), 0.2);
  MotionProblem& problem = c.random.problem;
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    const Eigen::Vector3d ray = c.random.points_in_cam1[i] / c.random.points_in_cam1[i].z();
    const double depth = (1.0 + thickness * rng.Uniform(-1.0, 1.0)) / c.plane.dot(ray);
    problem.matches[i] = ProjectToBoth(depth * ray, c.random.pose_true, problem.camera1, problem.camera2);
  }
  AddNoise(sigma_px, rng, &problem);
  problem.sigma_px = kTwistedSigmaPx;
  return c;
}

double MiddleSingularValue(const Eigen::Matrix3d& H) { return SingularValues(H)(1); }

// With R' + t' n'' = lambda H, lambda = +-1 / the middle singular value: t' n'' = lambda H - R' has rank one,
// and its columns are multiples of t'.
TEST(OtherMotionOfPlane, HasTheSameHomography) {
  RandomStream rng({.seed = 1, .purpose = 2731});
  for (int trial = 0; trial < 200; ++trial) {
    const RelativePose pose = RandomPose(rng, 30.0);
    const Eigen::Vector3d plane = rng.Uniform(0.05, 0.5) * RandomDirection(rng);
    const Eigen::Matrix3d H0 = pose.R + pose.t * plane.transpose();
    const std::optional<RelativePose> other = OtherMotionOfPlane(pose, {plane, plane});
    ASSERT_TRUE(other);
    EXPECT_NEAR(other->t.norm(), 1.0, 1e-12);
    EXPECT_LT((other->R * other->R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
    EXPECT_NEAR(other->R.determinant(), 1.0, 1e-9);
    const Eigen::Matrix3d H = H0 / MiddleSingularValue(H0);
    const double sign = (H - other->R).norm() < (H + other->R).norm() ? 1.0 : -1.0;
    const Eigen::Matrix3d rest = sign * H - other->R;
    const Eigen::Matrix3d beside_t = (Eigen::Matrix3d::Identity() - other->t * other->t.transpose()) * rest;
    EXPECT_LT(beside_t.norm(), 1e-7) << trial;
    EXPECT_GT(LocalCoordinates(pose, *other).norm(), 1e-6) << trial;
    // The twist of the other one is the first again, up to the direction's sign.
    const Eigen::Vector3d n = rest.transpose() * other->t;
    const std::optional<RelativePose> back = OtherMotionOfPlane(*other, {n, n});
    ASSERT_TRUE(back);
    EXPECT_LT((back->R - pose.R).norm(), 1e-6) << trial;
    EXPECT_LT(back->t.cross(pose.t).norm(), 1e-6) << trial;
  }
}

TEST(OtherMotionOfPlane, OfAPureRotationIsNone) {
  EXPECT_FALSE(OtherMotionOfPlane({RotationFromVector({0.1, 0.2, 0.3}), Eigen::Vector3d::UnitX()},
                                  {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()}));
}

// Matches without noise follow the motion without a residual. If `points_in_front`, they lie in front of both
// cameras.
void ExpectExplains(const RelativePose& pose, const MotionProblem& problem, bool points_in_front) {
  const Eigen::Matrix3d E = EssentialFromPose(pose);
  for (const Correspondence& match : problem.matches) {
    const Eigen::Vector3d ray1 = problem.camera1.Ray(match.x1_px), ray2 = problem.camera2.Ray(match.x2_px);
    EXPECT_NEAR(ray2.dot(E * ray1), 0.0, 1e-9);
    const double inverse_depth = InverseDepth(pose, ray1, ray2);
    EXPECT_TRUE(!points_in_front || inverse_depth > 0.0);
    EXPECT_TRUE(!points_in_front || (pose.R * ray1 + inverse_depth * pose.t).z() > 0.0);
  }
}

TEST(OtherMotionOfPlane, ExplainsTheMatchesOfThePlane) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const PlaneCase c = MakePlane(trial, 0.0, 0.0);
    const MotionProblem& problem = c.random.problem;
    const std::vector<double> right(problem.matches.size(), 0.99);
    const std::optional<VisiblePlane> plane = FindPlane(problem, c.random.pose_true, right, 0.9);
    ASSERT_TRUE(plane);
    const std::optional<RelativePose> other = OtherMotionOfPlane(c.random.pose_true, *plane);
    ASSERT_TRUE(other);
    ExpectExplains(*other, problem, false);
  }
}

// A road 1.5 baselines below a camera (y down) that moves forward. The plane of
// the other motion has a normal more than 90 deg from the given one: the points decide on which side it lies.
TEST(OtherMotionOfPlane, HasThePointsInFrontOfTheCameras) {
  RandomStream rng({.seed = 1, .purpose = 2733});
  const Camera camera{700.0, 700.0, 319.5, 239.5, 640, 480};
  for (int trial = 0; trial < 50; ++trial) {
    const RelativePose pose{RotationFromVector(0.05 * RandomDirection(rng)),
                            Eigen::Vector3d(rng.Uniform(-0.05, 0.05), 0.0, -1.0).normalized()};
    const Eigen::Vector3d road(rng.Uniform(-0.02, 0.02), 1.0 / 1.5, 0.0);
    MotionProblem problem{{}, camera, camera, kTwistedSigmaPx};
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d ray(rng.Uniform(-0.4, 0.4), rng.Uniform(0.1, 0.3), 1.0);
      problem.matches.push_back(ProjectToBoth(ray / road.dot(ray), pose, camera, camera));
    }
    const std::optional<VisiblePlane> plane = FindPlane(problem, pose, std::vector<double>(60, 0.99), 0.9);
    ASSERT_TRUE(plane) << trial;
    EXPECT_LT((plane->n - road).norm(), 1e-6);
    const std::optional<RelativePose> other = OtherMotionOfPlane(pose, *plane);
    ASSERT_TRUE(other) << trial;
    ExpectExplains(*other, problem, true);
  }
}

TEST(FindPlane, FindsThePlaneOfNoisyMatches) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    PlaneCase c = MakePlane(trial, 0.0);
    // A tenth of them, said to be right, lies far from it.
    for (size_t i = 0; i < 12; ++i) {
      const Eigen::Vector3d ray = c.random.problem.camera1.Ray(c.random.problem.matches[i].x1_px);
      c.random.problem.matches[i] =
          ProjectToBoth(2.0 * ray, c.random.pose_true, c.random.problem.camera1, c.random.problem.camera2);
    }
    const std::vector<double> right(c.random.problem.matches.size(), 0.99);
    const std::optional<VisiblePlane> plane = FindPlane(c.random.problem, c.random.pose_true, right, 0.6);
    ASSERT_TRUE(plane) << trial;
    EXPECT_LT((plane->n - c.plane).norm(), 0.02) << trial;
    EXPECT_FALSE(FindPlane(c.random.problem, c.random.pose_true, right, 0.97)) << trial;
  }
}

TEST(FindPlane, FindsNoneInAVolumeOrAmongFewMatches) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const PlaneCase c = MakePlane(trial, 0.8);
    std::vector<double> right(c.random.problem.matches.size(), 0.99);
    EXPECT_FALSE(FindPlane(c.random.problem, c.random.pose_true, right, 0.6)) << trial;
    std::fill(right.begin() + 4, right.end(), 0.1);
    EXPECT_FALSE(FindPlane(c.random.problem, c.random.pose_true, right, 0.0)) << trial;
  }
}

// Two in five matches lie on another plane, exactly, and are said to be a thousand times as noisy as the
// others: weights of a millionth leave the plane where it is, where equal ones would move it by 0.016.
TEST(FindPlane, WeighsMatchesByTheirNoise) {
  PlaneCase c = MakePlane(1, 0.0, 0.0);
  MotionProblem& problem = c.random.problem;
  problem.noise_scale.assign(120, 1.0);
  for (size_t i = 0; i < 48; ++i) {
    const Eigen::Vector3d ray = problem.camera1.Ray(problem.matches[i].x1_px);
    problem.matches[i] =
        ProjectToBoth(ray / (0.8 * c.plane.dot(ray)), c.random.pose_true, problem.camera1, problem.camera2);
    problem.noise_scale[i] = 1000.0;
  }
  const std::optional<VisiblePlane> plane =
      FindPlane(problem, c.random.pose_true, std::vector<double>(120, 0.99), 0.6);
  ASSERT_TRUE(plane);
  EXPECT_LT((plane->n - c.plane).norm(), 1e-3);
}

// 80 matches of the plane z = 5 ahead and 40 at the edges of a wide image, x = 1.7 focal lengths from the
// axis, off it by `off_sds` standard deviations of their inverse depth: the noise of the angle, sqrt(2) sigma
// / f, over the parallax that moving sideways gives at unit depth, |a x t| / |a|^2 = sqrt(1 + y^2) / (1 + x^2
// + y^2).
MotionProblem WideImageOfPlane(double off_sds, const RelativePose& pose) {
  const Camera camera{200.0, 200.0, 399.5, 299.5, 800, 600};
  MotionProblem problem{{}, camera, camera, kTwistedSigmaPx};
  for (int i = 0; i < 120; ++i) {
    const bool is_wide = i >= 80;
    const double x = is_wide ? (i % 2 == 0 ? 1.7 : -1.7) : 0.1 * (i % 9 - 4), y = 0.1 * (i / 4 % 9 - 4);
    const double sd =
        std::sqrt(2.0) * kTwistedSigmaPx / 200.0 * (1.0 + x * x + y * y) / std::sqrt(1.0 + y * y);
    const double inverse_depth = 0.2 + (is_wide ? (i / 2 % 2 == 0 ? off_sds : -off_sds) * sd : 0.0);
    problem.matches.push_back(
        ProjectToBoth(Eigen::Vector3d(x, y, 1.0) / inverse_depth, pose, camera, camera));
  }
  return problem;
}

// A match is near the plane within three standard deviations: with the wide ones all are, without them two
// thirds.
TEST(FindPlane, CountsWideMatchesByTheNoiseOfTheirDepth) {
  const RelativePose pose{Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitX()};
  const std::vector<double> right(120, 0.99);
  for (const double off_sds : {2.0, 6.0}) {
    const MotionProblem problem = WideImageOfPlane(off_sds, pose);
    EXPECT_EQ(FindPlane(problem, pose, right, 0.8).has_value(), off_sds < 3.0);
    const std::optional<VisiblePlane> plane = FindPlane(problem, pose, right, 0.6);
    ASSERT_TRUE(plane);
    EXPECT_LT((plane->n - Eigen::Vector3d(0.0, 0.0, 0.2)).norm(), 0.005);
  }
}

}  // namespace
}  // namespace rcme
