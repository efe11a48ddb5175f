// A simulated scene seen by two cameras that differ in everything: focal lengths, principal point, size. A
// formula that takes the wrong one of them cannot stay unseen.
#pragma once

#include "simulator/noise/noise_laws.h"
#include "simulator/observe.h"
#include "tests/test_support/random_problem.h"

namespace rcme {

// TestCamera1() and TestCamera2(), a random motion of up to 10 deg, points 4 to 16 baselines deep that both
// images show. Without a baseline the same points are seen by a camera that only turns.
inline Scene TwoCameraScene(int num_points, std::uint32_t trial, double baseline_m = 0.5) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 90});
  const RandomProblem random = MakeRandomProblem(rng, {.num_matches = num_points});
  Scene scene;
  scene.camera1 = random.problem.camera1;
  scene.camera2 = random.problem.camera2;
  scene.cam2_from_cam1_true = random.pose_true;
  scene.baseline_m = baseline_m;
  const double m_per_baseline = baseline_m > 0.0 ? baseline_m : 0.5;
  for (const Eigen::Vector3d& point : random.points_in_cam1) {
    scene.points_in_cam1.push_back(m_per_baseline * point);
  }
  return scene;
}

// Gaussian noise, and mismatches uniform over image 2.
inline Observation ObserveTwoCameraScene(const Scene& scene, double sigma_px, double outlier_ratio,
                                         std::uint32_t trial) {
  RandomStream noise_rng({.seed = 1, .trial = trial, .purpose = 91});
  RandomStream outlier_rng({.seed = 1, .trial = trial, .purpose = 92});
  return Observe(scene, *MakeGaussianNoise(sigma_px), OutlierModel(outlier_ratio), noise_rng, outlier_rng);
}

// What an estimator is given of them.
inline MotionProblem TwoCameraProblem(int num_matches, double sigma_px, double outlier_ratio,
                                      std::uint32_t trial, RelativePose* pose_true = nullptr) {
  const Scene scene = TwoCameraScene(num_matches, trial);
  if (pose_true) *pose_true = scene.cam2_from_cam1_true;
  return {ObserveTwoCameraScene(scene, sigma_px, outlier_ratio, trial).matches, scene.camera1, scene.camera2,
          sigma_px};
}

}  // namespace rcme
