// What an answer rests on: the matches that agree with it, their noise, their parallax, the plane they may
// lie on. Measured at the answer itself; the truth plays no part.
#pragma once

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Of the inliers of an answer; shares and medians are NaN where there are fewer than six distinct ones or
// they lie on one line.
struct MotionEvidence {
  int num_matches = 0, num_inliers = 0;
  double sigma_assumed_px = 0.0;
  double sigma_px = 0.0;     // EstimateNoise (real/truth_free/twin.h): stated, else from the median residual
  double sigma_sd_px = 0.0;  // its standard deviation
  double parallax_median_deg = 0.0;
  double parallax_to_noise = 0.0;  // median of the parallax over the noise of the angle between two rays
  double parallax_share = 0.0;     // that the best rotation alone does not explain, at 99.9 %
  double planar_share = 0.0;       // that the best homography explains, at 99.9 %

  // Residuals and assumption disagree: by more than a quarter and by more than three standard deviations.
  bool DoesNoiseDisagree() const;
};

// `estimate` holds a valid motion (status ok).
MotionEvidence ComputeEvidence(const MotionProblem& problem, const MotionEstimate& estimate);

}  // namespace rcme
