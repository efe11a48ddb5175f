// Random two-view problems whose truth is known. Points are projected by hand-written pinhole formulas: no
// epipolar code takes part, so the epipolar constraint stays a check.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"
#include "stats/random.h"

namespace rcme {

struct RandomProblemOptions {
  int num_matches = 8;
  double max_rotation_deg = 10.0;
  double min_depth = 4.0, max_depth = 16.0;  // in baselines
};

struct RandomProblem {
  MotionProblem problem;                        // without noise
  RelativePose pose_true;                       // cam2_from_cam1
  std::vector<Eigen::Vector3d> points_in_cam1;  // in baselines
};

inline Eigen::Vector3d RandomDirection(RandomStream& rng) {
  Eigen::Vector3d direction;
  do {
    direction = Eigen::Vector3d(rng.Normal(), rng.Normal(), rng.Normal());
  } while (direction.norm() < 1e-3);
  return direction.normalized();
}

// Rotation about a random axis by an angle uniform in [0, max_rotation_deg], translation in any direction.
inline RelativePose RandomPose(RandomStream& rng, double max_rotation_deg) {
  const double angle = rng.Uniform(0.0, max_rotation_deg * std::numbers::pi / 180.0);
  const Eigen::Vector3d axis = RandomDirection(rng);
  return {RotationFromVector(angle * axis), RandomDirection(rng)};
}

// Two different cameras, fx != fy in both.
inline Camera TestCamera1() { return {700.0, 650.0, 330.0, 235.0, 640, 480}; }
inline Camera TestCamera2() { return {820.0, 860.0, 395.0, 310.0, 800, 600}; }

// One point seen by both cameras: uniform over image 1, uniform in depth, drawn until image 2 sees it.
// Nothing after 200 draws: the images hardly overlap.
inline std::optional<Eigen::Vector3d> RandomPoint(const RelativePose& pose, const Camera& camera1,
                                                  const Camera& camera2, const RandomProblemOptions& options,
                                                  RandomStream& rng) {
  for (int draw = 0; draw < 200; ++draw) {
    const double depth = rng.Uniform(options.min_depth, options.max_depth);
    const double u = rng.Uniform(0.0, camera1.width - 1.0), v = rng.Uniform(0.0, camera1.height - 1.0);
    const Eigen::Vector3d point(depth * (u - camera1.cx) / camera1.fx, depth * (v - camera1.cy) / camera1.fy,
                                depth);
    const Eigen::Vector3d in_cam2 = pose.R * point + pose.t;
    if (in_cam2.z() <= 0.1) continue;
    const double u2 = camera2.fx * in_cam2.x() / in_cam2.z() + camera2.cx;
    const double v2 = camera2.fy * in_cam2.y() / in_cam2.z() + camera2.cy;
    if (u2 >= 0.0 && u2 <= camera2.width - 1.0 && v2 >= 0.0 && v2 <= camera2.height - 1.0) return point;
  }
  return std::nullopt;
}

inline Correspondence ProjectToBoth(const Eigen::Vector3d& point, const RelativePose& pose,
                                    const Camera& camera1, const Camera& camera2) {
  const Eigen::Vector3d in_cam2 = pose.R * point + pose.t;
  Correspondence match;
  match.x1_px << camera1.fx * point.x() / point.z() + camera1.cx,
      camera1.fy * point.y() / point.z() + camera1.cy;
  match.x2_px << camera2.fx * in_cam2.x() / in_cam2.z() + camera2.cx,
      camera2.fy * in_cam2.y() / in_cam2.z() + camera2.cy;
  return match;
}

// Motions whose images hardly overlap are drawn again.
inline RandomProblem MakeRandomProblem(RandomStream& rng, const RandomProblemOptions& options = {}) {
  const Camera camera1 = TestCamera1(), camera2 = TestCamera2();
  RandomProblem random;
  random.problem.camera1 = camera1;
  random.problem.camera2 = camera2;
  random.pose_true = RandomPose(rng, options.max_rotation_deg);
  while (static_cast<int>(random.problem.matches.size()) < options.num_matches) {
    const std::optional<Eigen::Vector3d> point =
        RandomPoint(random.pose_true, camera1, camera2, options, rng);
    if (!point) {
      random.points_in_cam1.clear();
      random.problem.matches.clear();
      random.pose_true = RandomPose(rng, options.max_rotation_deg);
      continue;
    }
    random.points_in_cam1.push_back(*point);
    random.problem.matches.push_back(ProjectToBoth(*point, random.pose_true, camera1, camera2));
  }
  return random;
}

inline void AddNoise(double sigma_px, RandomStream& rng, Correspondence* match) {
  for (double* coordinate : {&match->x1_px.x(), &match->x1_px.y(), &match->x2_px.x(), &match->x2_px.y()}) {
    *coordinate += sigma_px * rng.Normal();
  }
}

// Gaussian noise on every coordinate; the problem states its true sigma.
inline void AddNoise(double sigma_px, RandomStream& rng, MotionProblem* problem) {
  for (Correspondence& match : problem->matches) AddNoise(sigma_px, rng, &match);
  problem->sigma_px = sigma_px;
}

}  // namespace rcme
