// The residuals from which noise is estimated: those of the matches that agree with the least-squares motion
// of their pair.
#pragma once

#include <vector>

#include "estimator/robust_covariance/clustered_covariance.h"
#include "experiments/real/truth_free/pair_set.h"
#include "stats/pooled_scores.h"

namespace rcme {

// Residuals of one pair, in px, divided by size^exponent. The size is the match's stated noise over the
// median of the pair (MotionProblem::noise_scale).
struct FittedPair {
  ImageNumbers images;
  Camera camera;
  MatchScores scores;
  std::vector<double> sizes;      // of the fitted matches; empty: the pair states none
  std::vector<double> scales;     // divisors of the residuals: size^exponent, 1 without sizes
  std::vector<double> leverages;  // h_i = J_i A^-1 J_i'
  double variance = 0.0;          // sum r^2 / (n - 5), px^2
};

// Fits all pairs with a motion and at least 20 agreeing matches (FitAgreeing in robust_covariance.h) and
// skips the others. The agreement test cuts off at 99.9 % of a normal law (fit_set.h); residuals are scaled
// up to undo the loss of variance.
std::vector<FittedPair> FitPairs(const std::vector<PairAnswers>& answers, double exponent);

// The exponent with which residuals grow with the stated size. It starts at zero and is increased by the
// slope of log(r^2 / (1 - h)) on log size^2 within pairs (least squares as in truth_free/size_test.h), with
// residuals divided by size^exponent, until the slope is zero. The agreement test then cuts off the same
// share at all sizes. NaN if no pair states sizes.
PooledParameter FitSizeExponent(const std::vector<PairAnswers>& answers);

}  // namespace rcme
