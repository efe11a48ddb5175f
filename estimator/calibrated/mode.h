#pragma once

#include "estimator/calibrated/mixture_parameters.h"
#include "estimator/geometry/pose.h"
#include "estimator/kernels/match_blocks.h"

namespace rcme {

// Matches that alone must support a motion beside another one for both to be motions of their own.
inline constexpr size_t kLeastOfSecondMotion = 12;

// The origin of a mode.
enum class ModeOrigin {
  kSample,       // a minimal sample
  kTwistedPair,  // the other motion of a plane (twisted_pair.h)
  kLeverage,     // a fit without a match of large influence (leverage_branches.h)
  kOppositeWay,  // the same E with the opposite translation
};

// One explanation of the matches: a motion at an optimum of the mixture likelihood. With a prior of the
// motion, it is at an optimum of the posterior, and log_likelihood and hessian include the prior.
struct Mode {
  RelativePose pose;
  MixtureParameters mixture;
  MatchMask used;                       // all other matches count as outliers
  double log_likelihood = 0.0;          // over the used matches, per unit of the assumed sigma
  Matrix5d hessian = Matrix5d::Zero();  // of -log_likelihood in the tangent at `pose`; kept positive
  Matrix5d inverse_hessian = Matrix5d::Zero();
  ModeOrigin origin = ModeOrigin::kSample;
};

}  // namespace rcme
