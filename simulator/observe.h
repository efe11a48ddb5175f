#pragma once

#include <cstdint>
#include <vector>

#include "estimator/geometry/correspondence.h"
#include "simulator/camera_defects.h"
#include "simulator/noise_model.h"
#include "simulator/outlier_model.h"
#include "simulator/scene.h"

namespace rcme {

// The noisy matches in random order, and which of them are true (for scoring alone).
struct Observation {
  std::vector<Correspondence> matches;
  std::vector<std::uint32_t> point;  // the scene point of each match; for a wrong one, before it became wrong
  std::vector<bool> is_inlier_true;
  std::vector<bool> is_undetectable;  // wrong, but on the true epipolar line
  std::vector<double> noise_scale;    // as the detector states it (noise_model.h); may be empty
  double weight = 1.0;                // of the trial (outlier_model.h)
};

// Noise and outliers draw from separate streams, so the noise of a match does not depend on the outlier
// ratio. Noise may move a point slightly outside the image, which a real detector would not; it is kept.
// Throws InputError where the distortion folds an image and where the outlier law finds no place.
Observation Observe(const Scene& scene, const NoiseModel& noise, const OutlierModel& outliers,
                    RandomStream& noise_rng, RandomStream& outlier_rng, const CameraDefects& defects = {});

}  // namespace rcme
