// How much of the residuals' variance neighbouring matches share, and up to which distance, over all pairs of
// a camera.
#pragma once

#include <vector>

#include "experiments/real/camera_noise/fitted_pairs.h"
#include "stats/pooled_scores.h"

namespace rcme {

// Variance, px^2, of a field whose correlation at distance d is exp(-d / reach).
struct VarianceByReach {
  double reach_px = 0.0;
  PooledParameter variance;
  double gain = 0.0;  // in log-likelihood, with pairs taken as normal: score^2 / (2 information)
};

struct SharedVariance {
  std::vector<VarianceByReach> by_reach;  // from 10 px to the diagonal of the image
  bool is_found = false;                  // at 5 %, one-sided
  VarianceByReach field;                  // at the reach of greatest gain, interpolated by a parabola
  double reach_factor = 1.0;        // standard error of the reach as a factor, by a jackknife over pairs
  PooledParameter key_point;        // variance shared by matches of one key point, px^2; NaN: too few repeats
  bool is_key_point_found = false;  // at 1 %, one-sided
  PooledParameter own;              // of each match alone, without the parts that were found, px^2
  VarianceByReach unseen;           // expected if no field is found, with the image diagonal as reach, px^2
};

// E[v | estimate] of a variance v that a test may have missed. The prior: v is zero with probability 1/2,
// else its logarithm is uniform from a hundredth of `total` to `total`. The estimate is normal about v, with
// the standard deviation that its 95 % interval implies. Returns 0 for a NaN estimate.
double ExpectVariance(const PooledParameter& estimate, double total);

// In each pair only the first match of each key point is used. The moments q of its residuals
// (ResidualMoments in estimator/robust_covariance/residual_variances.h) have the weights W_0 = I and W_f =
// K_f - I between the projections P = I - U U' that remain after the fit of the motion. Their expectation is
// q = T v, with the matches' own variance v_0 and the field's v_f. For normal, independent residuals of
// variance s^2 the covariance of q would be 2 s^4 M, M_ab = tr(W_a P W_b P). Generalised least squares has
// the normal equations
//
//   N = T' M^-1 T / (2 s^4),   b = T' M^-1 q / (2 s^4).
//
// v_0 is eliminated in each pair, so that pairs may differ in noise. The score b_f - N_f0 b_0 / N_00 and the
// information N_ff - N_f0 N_0f / N_00 of the field are pooled over pairs (stats/pooled_scores.h). The
// standard error comes from the scatter between pairs, so it is valid if residuals are not normal. The test
// for a field is Student's t on the mean over pairs of score / information^1/2, clipped to +-3, each at the
// reach that the other pairs choose. It stays valid despite the choice of reach and with fields of very
// different size. The variance that matches of one key point share is then estimated from all matches, given
// the field.
SharedVariance FitSharedVariance(const std::vector<FittedPair>& pairs);

}  // namespace rcme
