#pragma once

#include <optional>
#include <vector>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"
#include "estimator/motion_prior.h"

namespace rcme {

// The input of an estimator: the matches, the cameras, and the assumed noise.
struct MotionProblem {
  std::vector<Correspondence> matches;
  Camera camera1, camera2;
  double sigma_px = 0.5;  // assumed standard deviation of the noise per coordinate in each image (a.2)
  // Of each match, how many times as great its noise is as sigma_px: 1 in the median. Empty: all alike.
  std::vector<double> noise_scale = {};
  // What is known of the motion beside the matches; only estimators that say so use it
  // (EstimatorEntry::uses_motion_prior).
  std::optional<MotionPrior> prior = {};
};

}  // namespace rcme
