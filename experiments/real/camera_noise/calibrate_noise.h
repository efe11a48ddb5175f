// Estimates the errors of a camera and its front end from pairs of its images.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/data/camera_noise.h"
#include "experiments/real/camera_noise/shared_variance.h"
#include "experiments/real/truth_free/calibration_test.h"
#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

// Noise of the matches whose stated size over the median size of their pair lies in [from, to).
struct SigmaOfSize {
  double from = 0.0, to = 0.0;
  PooledParameter variance;  // px^2
  std::int64_t num_matches = 0;
};

struct NoiseCalibration {
  CameraNoise noise;                                             // content of the noise file
  int num_given = 0, num_other_cameras = 0, num_unanswered = 0;  // pairs; the last two are left out
  PooledParameter variance;                                      // sigma_px^2
  PooledParameter size_exponent;
  std::vector<SigmaOfSize> sizes;
  SharedVariance shared;
  CalibrationReport faults;
  DisplacementCells systematic;  // as tested; also in `noise` if p < .05
};

// Estimates, each on pairs corrected for the previous ones: first the faults of the camera
// (truth_free/self_calibration.h), then the displacement that all images share, then the noise, its growth
// with the stated size and its shared part. The camera is that of the first pair. Throws InputError with
// fewer than five pairs of this camera that have a motion. The random stream of a pair depends only on the
// seed and the pair's name.
NoiseCalibration CalibrateNoise(const PairSet& set, const MotionEstimator& estimator,
                                const std::string& estimator_name, std::uint64_t seed);

}  // namespace rcme
