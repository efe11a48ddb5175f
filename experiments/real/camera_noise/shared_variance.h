// How much of the residuals' variance is shared by matches near each other, and how far that reaches, over
// all pairs of a camera.
#pragma once

#include <vector>

#include "experiments/real/camera_noise/fitted_pairs.h"
#include "stats/pooled_scores.h"

namespace rcme {

// Of one reach: the variance of a field whose correlation is exp(-d / reach), px^2.
struct VarianceByReach {
  double reach_px = 0.0;
  PooledParameter variance;
  double gain = 0.0;  // of the likelihood, as if pairs were normal: score^2 / (2 information)
};

struct SharedVariance {
  std::vector<VarianceByReach> by_reach;  // from 10 px to the diagonal of the image
  bool is_found = false;                  // at 5 %, one-sided
  VarianceByReach field;                  // at the reach of greatest gain, between those by a parabola
  double reach_factor = 1.0;              // one standard error of it, a jackknife over pairs
  PooledParameter key_point;              // variance that matches of one key point share, px^2; NaN: none do
  bool is_key_point_found = false;        // at 1 %, one-sided
  PooledParameter own;                    // each match's own, beside what is found, px^2
  VarianceByReach unseen;  // at the diagonal of the image, expected where no field is found, px^2
};

// E[v | estimate] of a variance within `total`, which is nil with probability 1/2 and else, its logarithm
// uniform, from a hundredth of the total to all of it: what a test may miss. The estimate is normal about v,
// with a standard deviation that gives its interval of 95 %. NaN estimates say nothing: 0.
double ExpectVariance(const PooledParameter& estimate, double total);

// In each pair the first match of each key point stands for all. Its moments (ResidualMoments in
// estimator/robust_covariance/residual_variances.h), of weights W_0 = I and W_f = K_f - I between the
// projections P = I - U U' that the fitted motion leaves, are q = T v of the matches' own variance v_0 and
// the field's v_f. Were residuals normal, independent and of variance s^2, the q would have the covariance 2
// s^4 M, M_ab = tr(W_a P W_b P). Generalised least squares has the normal equations
//
//   N = T' M^-1 T / (2 s^4),   b = T' M^-1 q / (2 s^4).
//
// v_0 is eliminated in each pair, so that pairs may be of different noise: score b_f - N_f0 b_0 / N_00 and
// information N_ff - N_f0 N_0f / N_00 of the field are pooled over pairs (stats/pooled_scores.h). The
// standard error is that of the pairs' scatter, and holds where residuals are not normal. A field is found
// by the mean over pairs of score / information^1/2, within +-3, each at the reach that the other pairs
// choose: one Student's t by their scatter, which neither that choice nor how unlike fields are in size makes
// unsure. What matches of one key point share follows from all matches, the field given.
SharedVariance FitSharedVariance(const std::vector<FittedPair>& pairs);

}  // namespace rcme
