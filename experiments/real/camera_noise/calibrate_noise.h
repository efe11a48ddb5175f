// The errors of a camera and its front end, learnt from the pairs that it took.
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

// Noise of the matches whose stated size lies in a range, over the median size of their pair.
struct SigmaOfSize {
  double from = 0.0, to = 0.0;
  PooledParameter variance;  // px^2
  std::int64_t num_matches = 0;
};

struct NoiseCalibration {
  CameraNoise noise;                                             // what the file says
  int num_given = 0, num_other_cameras = 0, num_unanswered = 0;  // pairs; the last two are left out
  PooledParameter variance;                                      // sigma_px^2
  PooledParameter size_exponent;
  std::vector<SigmaOfSize> sizes;
  SharedVariance shared;
  CalibrationReport faults;
  DisplacementCells systematic;  // tested; in `noise` where p < 0.05
};

// In this order, each on pairs without what was found before: faults of the camera (truth_free/
// self_calibration.h), the displacement that all images share, the noise, its growth with the size and what
// is shared of it. The camera is that of the first pair. Throws InputError with fewer than five pairs that
// are answered and of one camera. Pure in the seed and the pairs' names.
NoiseCalibration CalibrateNoise(const PairSet& set, const MotionEstimator& estimator,
                                const std::string& estimator_name, std::uint64_t seed);

inline constexpr double kSystematicLevel = 0.05;

}  // namespace rcme
