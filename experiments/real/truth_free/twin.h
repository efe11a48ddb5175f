// The simulated twin of a pair: its matches as they would be if the estimate were the truth and errors were
// independent.
#pragma once

#include "estimator/motion_estimate.h"
#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

Eigen::Matrix3d ComputeFundamental(const MotionProblem& problem, const RelativePose& pose);

// Moves a match to the nearest one that satisfies F, to second order of the distance.
Correspondence Snapped(const Eigen::Matrix3d& F, Correspondence match);

// Noise of the inliers, px, for a match of noise_scale 1 (MotionProblem). It is the estimator's own value if
// there is one, else it is computed from the median of the residuals.
double EstimateNoise(const MotionProblem& problem, const MotionEstimate& estimate);

// The part of a twin's noise that is a field over each image (simulator/noise/displacement_field.h), drawn
// anew for each image and twin.
struct TwinField {
  double share = 0.0;  // of the variance; 0: there is none
  double reach_px = 0.0;
};

// Moves the inliers to the nearest points that satisfy the estimated motion and adds new normal noise, with
// standard deviation EstimateNoise times the match's noise_scale. All other matches stay as they are. Noise
// outside the field is drawn for each key point: matches that share a key point, also in other pairs of the
// image, share its noise. `twin`: the number of the twin.
NamedPair MakeTwin(const NamedPair& pair, const MotionEstimate& estimate, std::uint64_t seed,
                   std::uint32_t twin, const TwinField& field = {});

}  // namespace rcme
