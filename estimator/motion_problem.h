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
  // Standard deviation of each match's noise over sigma_px; the median is 1. Empty: all matches have noise
  // sigma_px.
  std::vector<double> noise_scale = {};
  // Prior knowledge of the motion; only rcme_calibrated uses it.
  std::optional<MotionPrior> prior = {};
  // Quality of each match, finite; greater is better. Empty: not known. Only samplers that take the best
  // matches first use it (opencv_usac).
  std::vector<double> match_quality = {};
};

}  // namespace rcme
