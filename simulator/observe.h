#pragma once

#include <cstdint>
#include <vector>

#include "estimator/geometry/correspondence.h"
#include "simulator/camera_defects.h"
#include "simulator/noise_model.h"
#include "simulator/outlier_model.h"
#include "simulator/scene.h"

namespace rcme {

// What the two images give: noisy matches in random order, and which of them are true (for scoring alone).
struct Observation {
  std::vector<Correspondence> matches;
  std::vector<std::uint32_t> point;  // which point of the scene each match is of, or was of
  std::vector<bool> is_inlier_true;
  std::vector<bool> is_undetectable;  // wrong, but on the true epipolar line: no epipolar test can tell it
  std::vector<double> noise_scale;    // what the detector says of each (noise_model.h); empty: nothing
  double weight = 1.0;                // of the trial (outlier_model.h)
};

// Noise and outliers each draw from a stream of their own, so that the noise of a match does not depend on
// the outlier ratio. Noise may carry a point a little over the image border, as a detector's would not; it is
// left there.
Observation Observe(const Scene& scene, const NoiseModel& noise, const OutlierModel& outliers,
                    RandomStream& noise_rng, RandomStream& outlier_rng, const CameraDefects& defects = {});

}  // namespace rcme
