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
  bool is_found = false;                  // at 5 %, one-sided, all reaches together (Bonferroni)
  VarianceByReach field;                  // at the reach of greatest gain, between those by a parabola
  double reach_factor = 1.0;              // one standard error of it, a jackknife over pairs
  PooledParameter key_point;              // variance that matches of one key point share, px^2; NaN: none do
  bool is_key_point_found = false;        // at 5 %, one-sided
  PooledParameter own;                    // each match's own, beside what is found, px^2
};

// In each pair one match of each key point stands for all, so that
// restricted moments (estimator/robust_covariance/residual_variances.h), which know that the motion of each
// pair was fitted to its residuals: q = T v. In each pair of variance s^2 the own variance, and what matches
// of one key point share, are eliminated from the normal equations N = T' M^-1 T / (2 s^4) and b = T' M^-1 q
// / (2 s^4) of independent residuals, so that pairs may be of different noise; what is left, score b_f - N_fo
// N_oo^-1 b_o and information N_ff - N_fo N_oo^-1 N_of of the field, is pooled over pairs
// (stats/pooled_scores.h): the standard error is that of the pairs' scatter, and holds where residuals are
// not normal.
SharedVariance FitSharedVariance(const std::vector<FittedPair>& pairs);

}  // namespace rcme
