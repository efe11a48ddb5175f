// The simulated twin of a pair: what the matches would be if the estimate were the truth and errors
// independent.
#pragma once

#include <string>

#include "estimator/motion_estimate.h"
#include "experiments/real/truth_free/pair_set.h"
#include "stats/random.h"

namespace rcme {

Eigen::Matrix3d ComputeFundamental(const MotionProblem& problem, const RelativePose& pose);

// The match moved onto the nearest one that satisfies F, to second order of the distance.
Correspondence Snapped(const Eigen::Matrix3d& F, Correspondence match);

// Residual noise of the matches that agree with an answer, px, of one as noisy as the median
// (MotionProblem::noise_scale): as the estimator says, else from the median of their residuals.
double EstimateNoise(const MotionProblem& problem, const MotionEstimate& estimate);

// What of a twin's noise is a field over each image (simulator/noise/displacement_field.h), drawn anew for
// each image and twin.
struct TwinField {
  double share = 0.0;  // of the variance; 0: there is none
  double reach_px = 0.0;
};

// The inliers of an answer at the nearest points that satisfy it, with normal noise of its standard
// deviation, times each match's noise_scale, anew; all other matches as they are. But for the field the noise
// is each key point's own: matches that share one, of this or another pair of the image, share its noise.
// `twin`: the number of the twin.
NamedPair MakeTwin(const NamedPair& pair, const MotionEstimate& estimate, std::uint64_t seed,
                   std::uint32_t twin, const TwinField& field = {});

}  // namespace rcme
