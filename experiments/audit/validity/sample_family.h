// Random samples of correct matches, for measuring how well a covariance covers: a scene of the default
// uniform volume with another baseline, m matches to estimate from and one fresh match.
#pragma once

#include "estimator/motion_problem.h"
#include "experiments/data/data_source.h"
#include "simulator/scene_generator.h"

namespace rcme {

// The m sample matches as a problem, and the one that took no part in it.
struct ObservedSample {
  MotionProblem problem;
  Correspondence fresh_match;
};

// Const and shared by threads; everything is a pure function of the names.
class SampleFamily {
 public:
  SampleFamily(int num_points, double baseline_m, double sigma_px);

  Scene MakeScene(const StreamName& name) const;
  // The scene's matches with noise from `noise_rng`; their order depends on the name alone.
  ObservedSample Observe(const Scene& scene, const StreamName& name, RandomStream& noise_rng) const;
  // The same matches in the same order without noise; the problem states the same sigma.
  ObservedSample ObserveExactly(const Scene& scene, const StreamName& name) const;

 private:
  ObservedSample ObserveWith(double noise_px, const Scene& scene, const StreamName& name,
                             RandomStream& noise_rng) const;

  SceneGenerator scenes_;
  double sigma_px_;
};

// Angle at a point between the rays to the two camera centres.
double ParallaxRad(const Scene& scene, const Eigen::Vector3d& point_in_cam1);

}  // namespace rcme
