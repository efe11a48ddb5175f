// The result of the modes' weights and the model check.
#pragma once

#include "estimator/calibrated/unstated_errors.h"
#include "estimator/calibrated/weigh_modes.h"

namespace rcme {

struct ModesVerdict {
  double by_modes = 1.0;             // probability of failure according to the modes alone
  double failure_probability = 1.0;  // after the model check, and with uncertain intrinsics
  double mass_beyond = 0.0;          // weight of the modes within the bounds that lies beyond them
  // The share of the probability within the bounds that is left if the intrinsics are more uncertain than
  // usual (intrinsics_check.h).
  double left_by_intrinsics = 1.0;
  UnstatedErrors unstated_errors = {};  // of the calibration; in pose_cov unless CovarianceKind::kRobust
  Matrix5d pose_cov = Matrix5d::Zero();
  Matrix5d pose_cov_with_errors = Matrix5d::Zero();  // if the calibration has these errors
};

// Applies the check to the weights. A probability of failure that it adds becomes weight of no motion. One
// that it removes is taken from the rivals and from no motion, and given to the other modes.
ModeWeights ReweighModes(ModeWeights weights, const ModesVerdict& verdict);

}  // namespace rcme
