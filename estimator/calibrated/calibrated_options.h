#pragma once

#include <vector>

#include "estimator/robust_covariance/robust_covariance.h"
#include "parameters/parameter.h"

namespace rcme {

// What is known of the noise level before the residuals are seen.
enum class SigmaKnowledge {
  kEstimated,  // the assumed sigma is a guess, good to a factor of about four; one that is far off raises P
  kAssumed,    // it is right
};

enum class CovarianceKind {
  kInformation,  // the inverse of the likelihood's Hessian
  kSandwich,     // HC3: the residuals themselves give their variances
  kRobust,       // the sandwich, for errors that are not independent (robust_covariance.h)
};

// Steps that can be left out, to see what they are worth.
enum class CalibratedStep {
  kNone,
  kSplit,
  kInfluence,
  kBranches,
  kTwistedPair,
  kOppositeWay,
  kDirectionPosterior,
  kNoiseChoice,
  kModelCheck,
};

// Options of rcme_calibrated.
struct CalibratedOptions {
  int min_samples = 64, max_samples = 10000;
  int num_candidates = 16;  // refined a little
  int num_modes = 4;        // of these to the optimum

  // The motion is wrong if its rotation or its direction is further off.
  double max_rotation_error_deg = 3.0, max_direction_error_deg = 15.0;
  double max_failure_probability = 1.0;  // greater: refused

  SigmaKnowledge sigma = SigmaKnowledge::kEstimated;
  CovarianceKind covariance = CovarianceKind::kSandwich;
  // Odds that a second motion which explains as many matches as the answer is the camera's; see
  // mode_weights.h.
  double second_motion_odds = 0.6;
  CalibratedStep leave_out = CalibratedStep::kNone;
  CalibrationPrior calibration;    // its effect is added to the covariance
  RobustCovarianceOptions robust;  // of kRobust; its calibration is the one above
};

// The fields by name; valid as long as `options` lives.
std::vector<Parameter> Parameters(CalibratedOptions& options);

// Throws InputError where two options contradict each other.
void Validate(const CalibratedOptions& options);

}  // namespace rcme
