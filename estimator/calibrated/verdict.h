// What follows from the weights of the modes and the check of their model.
#pragma once

#include "estimator/calibrated/weigh_modes.h"

namespace rcme {

struct Verdict {
  double by_modes = 1.0;             // the probability of failure by the modes alone
  double failure_probability = 1.0;  // and with the check of their model
  double mass_beyond = 0.0;          // of the modes within the bounds: what of them lies beyond
  Matrix5d pose_cov = Matrix5d::Zero();
};

// The weights after the check: what it adds to the probability of failure is weight of no mode; what it takes
// away is taken from the rivals and given to the others.
ModeWeights ReweighModes(ModeWeights weights, const Verdict& verdict);

}  // namespace rcme
