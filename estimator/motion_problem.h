#pragma once

#include <optional>
#include <vector>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"
#include "estimator/geometry/lens.h"
#include "estimator/motion_prior.h"

namespace rcme {

// How the matches of a problem were undistorted (undistortion.h). Errors of the calibration are those of
// these lenses.
struct Undistortion {
  Lens lens1, lens2;
  // The noise of the median match in pinhole pixels over that in the pixels of the images.
  double noise_growth = 1.0;
};

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
  std::optional<Undistortion> undistortion = {};  // nothing: the images have no distortion
};

}  // namespace rcme
