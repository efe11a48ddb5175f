// What PoseLib's estimators have in common.
#pragma once

#include <PoseLib/poselib.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "estimator/estimator_model.h"
#include "estimator/motion_problem.h"
#include "parameters/parameter.h"

namespace rcme {

// Defaults are PoseLib's.
struct PoseLibOptions {
  double threshold_sigma = 2.0;
  double confidence = 0.9999;
  int min_iterations = 1000;
  int max_iterations = 100000;
};
std::vector<Parameter> Parameters(PoseLibOptions& options);

poselib::Camera MakePoseLibCamera(const Camera& camera);

std::unique_ptr<MotionEstimator> MakePoseLib(const PoseLibOptions& options);

// Sets the stopping rule of PoseLib's RansacOptions, or of a type with the same members.
template <typename Ransac>
void SetStoppingRule(const PoseLibOptions& options, std::uint32_t seed, Ransac* ransac) {
  ransac->min_iterations = static_cast<std::size_t>(options.min_iterations);
  ransac->max_iterations = static_cast<std::size_t>(options.max_iterations);
  ransac->success_prob = options.confidence;
  ransac->seed = seed;
}

}  // namespace rcme
