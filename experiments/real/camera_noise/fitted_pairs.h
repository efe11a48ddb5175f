// The residuals that noise is learnt from: those of the matches that agree with the least-squares motion of
// their pair.
#pragma once

#include <vector>

#include "estimator/robust_covariance/clustered_covariance.h"
#include "experiments/real/truth_free/pair_answers.h"
#include "stats/pooled_scores.h"

namespace rcme {

// Of one pair, residuals in px over size^exponent, size the match's stated noise over the median one
// (MotionProblem::noise_scale).
struct FittedPair {
  ImageNumbers images;
  Camera camera;
  MatchScores scores;
  std::vector<double> sizes;      // of the fitted matches; empty: the pair states none
  std::vector<double> scales;     // size^exponent, 1 without sizes: what residuals are divided by
  std::vector<double> leverages;  // h_i = J_i A^-1 J_i'
  double variance = 0.0;          // sum r^2 / (n - 5), px^2
};

// Pairs with a motion and at least 20 agreeing matches (robust_covariance.h: FitAgreeing), the others left
// out. The cut lies at the 99.9 % of a normal law (fit_set.h); residuals are as much greater as it takes for
// its variance.
std::vector<FittedPair> FitPairs(const std::vector<PairAnswers>& answers, double exponent);

// The power of the stated size that residuals grow with: within each pair the slope of log(r^2 / (1 - h)) on
// log size^2, least squares as in truth_free/size_test.h, at residuals over size^exponent until it is zero.
// What is cut off is then the same share of all sizes. NaN where no pair states sizes.
PooledParameter FitSizeExponent(const std::vector<PairAnswers>& answers);

}  // namespace rcme
