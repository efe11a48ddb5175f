// The result of the modes' weights and the model check.
#pragma once

#include "estimator/calibrated/unstated_errors.h"
#include "estimator/calibrated/weigh_modes.h"

namespace rcme {

// Covariances of a motion: if the calibration has no errors that nobody stated, if it has, and the second
// moment of both cases.
struct ModeSpread {
  Matrix5d exact = Matrix5d::Zero(), with_errors = Matrix5d::Zero(), mixed = Matrix5d::Zero();
};

struct ModesVerdict {
  double by_modes = 1.0;             // probability of failure according to the modes alone
  double failure_probability = 1.0;  // after the model check, and with uncertain intrinsics
  double mass_beyond = 0.0;          // weight of the modes within the bounds that lies beyond them
  // The share of the probability within the bounds that is left if the intrinsics are more uncertain than
  // usual (intrinsics_check.h).
  double left_by_intrinsics = 1.0;
  UnstatedErrors unstated_errors = {};  // of the calibration; in pose_cov unless CovarianceKind::kRobust
  ModeSpread pose_cov = {};             // of the answer
};

// Applies the check to the weights. A probability of failure that it adds becomes weight of no motion. One
// that it removes is taken from the rivals and from no motion, and given to the other modes.
ModeWeights ReweighModes(ModeWeights weights, const ModesVerdict& verdict);

}  // namespace rcme
