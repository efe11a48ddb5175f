#pragma once

#include "estimator/calibrated/mixture_parameters.h"
#include "estimator/geometry/pose.h"
#include "estimator/kernels/match_blocks.h"

namespace rcme {

// Where a mode comes from.
enum class ModeOrigin {
  kSample,       // a minimal sample
  kTwistedPair,  // the other motion of a plane (twisted_pair.h)
  kLeverage,     // a fit without a match of large influence (leverage_branches.h)
  kOppositeWay,  // the same E, the other way
};

// One explanation of the matches: a motion at an optimum of the mixture likelihood, or of the posterior where
// a prior of the motion is given: then log_likelihood and the Hessian have its part.
struct Mode {
  RelativePose pose;
  MixtureParameters mixture;
  MatchMask used;                       // the others count as wrong matches
  double log_likelihood = 0.0;          // of the used ones, per unit of the assumed sigma
  Matrix5d hessian = Matrix5d::Zero();  // of -log_likelihood by the tangent at `pose`; kept positive
  Matrix5d inverse_hessian = Matrix5d::Zero();
  ModeOrigin origin = ModeOrigin::kSample;
};

}  // namespace rcme
