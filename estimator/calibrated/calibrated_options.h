#pragma once

#include <vector>

#include "estimator/robust_covariance/robust_covariance.h"
#include "parameters/parameter.h"

namespace rcme {

// How well the noise level is known beforehand.
enum class SigmaKnowledge {
  kEstimated,  // the assumed sigma may be wrong by a factor of about four; a large correction raises P
  kAssumed,    // the assumed sigma is exact
};

enum class CovarianceKind {
  kInformation,  // the inverse of the likelihood's Hessian
  kSandwich,     // HC2: variances from the residuals themselves
  // For dependent errors (robust_covariance.h). On average no smaller than the checked sandwich, both before
  // unstated errors of the calibration.
  kRobust,
};

// A step to leave out in an ablation.
enum class CalibratedStep {
  kNone,
  kSplit,
  kSecondMotion,  // the search among the matches that no mode explains (second_motion.h)
  kInfluence,
  kBranches,
  kTwistedPair,
  kOppositeWay,
  kDirectionPosterior,
  kNoiseChoice,
  kNoiseShape,    // the second fit with anisotropic noise (noise_shape.h)
  kUsualMotions,  // the prior of the motion (mode_weights.h)
  kModelCheck,
};

// Options of rcme_calibrated.
struct CalibratedOptions {
  int min_samples = 64, max_samples = 10000;
  int num_candidates = 8;  // hypotheses refined by a few steps
  int num_modes = 4;       // how many of them are refined to the optimum

  // The failure bounds: a motion counts as wrong if either error exceeds its bound.
  double max_rotation_error_deg = 3.0, max_direction_error_deg = 15.0;
  double max_failure_probability = 1.0;  // a motion with a greater probability is refused

  SigmaKnowledge sigma = SigmaKnowledge::kEstimated;
  CovarianceKind covariance = CovarianceKind::kSandwich;
  // Odds that a second motion is the camera's if it explains as many matches as the answer, over as large an
  // area (mode_weights.h).
  double second_motion_odds = 0.6;
  CalibratedStep leave_out = CalibratedStep::kNone;
  CalibrationPrior calibration;  // uncertainty of the intrinsics, added to the covariance
  // Prior probability that the calibration has errors of usual size, of the kinds that `calibration` does not
  // state (unstated_errors.h).
  double unstated_errors = 0.01;
  RobustCovarianceOptions robust;  // for kRobust; its calibration is taken from the field above
};

// The fields by name. They point into `options`, which must outlive them.
std::vector<Parameter> Parameters(CalibratedOptions& options);

// Throws InputError if two options contradict each other, or one of the robust covariance has no effect.
void Validate(const CalibratedOptions& options);

}  // namespace rcme
