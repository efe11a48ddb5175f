// The evidence for an answer: the matches that agree with it, their noise, their parallax, and the plane on
// which they may lie. It is measured at the answer itself, without the truth.
#pragma once

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Evidence from the inliers of an answer. Shares and medians are NaN if there are fewer than six distinct
// inliers or these lie on one line.
struct MotionEvidence {
  int num_matches = 0, num_inliers = 0;
  double sigma_assumed_px = 0.0;
  double sigma_px = 0.0;     // EstimateNoise (real/truth_free/twin.h): stated, or from the median residual
  double sigma_sd_px = 0.0;  // standard deviation of sigma_px
  double parallax_median_deg = 0.0;
  double parallax_to_noise = 0.0;  // median of the parallax over the noise of the angle between two rays
  double parallax_share = 0.0;     // inliers that the best rotation alone does not explain, at 99.9 %
  double planar_share = 0.0;       // inliers that the best homography explains, at 99.9 %

  // Returns whether residuals and assumption disagree: by more than a quarter and by more than three
  // standard deviations.
  bool DoesNoiseDisagree() const;
};

// `estimate` must be a valid motion (status ok).
MotionEvidence ComputeEvidence(const MotionProblem& problem, const MotionEstimate& estimate);

}  // namespace rcme
