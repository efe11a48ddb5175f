// Random samples of correct matches, to measure how well a covariance covers: a scene of the default uniform
// volume with another baseline, m matches for the estimate and one fresh match.
#pragma once

#include "estimator/motion_problem.h"
#include "experiments/data/data_source.h"
#include "simulator/scene_generator.h"

namespace rcme {

// The m sample matches as a problem, and the match that took no part in it.
struct ObservedSample {
  MotionProblem problem;
  Correspondence fresh_match;
};

// Threads may share one object. Every result is a pure function of the names.
class SampleFamily {
 public:
  SampleFamily(int num_points, double baseline_m, double sigma_px);

  Scene MakeScene(const StreamName& name) const;
  // The scene's matches with noise from `noise_rng`. Their order depends only on the name.
  ObservedSample Observe(const Scene& scene, const StreamName& name, RandomStream& noise_rng) const;
  // The same matches in the same order without noise; the problem states the same sigma.
  ObservedSample ObserveExactly(const Scene& scene, const StreamName& name) const;

 private:
  ObservedSample ObserveWith(double noise_px, const Scene& scene, const StreamName& name,
                             RandomStream& noise_rng) const;

  SceneGenerator scenes_;
  double sigma_px_;
};

// Angle at a point between the rays to the two camera centres, rad.
double ParallaxRad(const Scene& scene, const Eigen::Vector3d& point_in_cam1);

}  // namespace rcme
