// Tests whether residuals grow with the matches' stated noise.
#pragma once

#include <string>
#include <vector>

#include "experiments/real/truth_free/pair_set.h"
#include "experiments/real/truth_free/truth_free_verdict.h"
#include "stats/pooled_scores.h"

namespace rcme {

// A slope within this of one is nominal.
inline constexpr double kNominalSlope = 0.25;

struct SizeReport {
  int num_pairs = 0;  // whose matches have a noise_scale
  // Slope of log r^2 on log noise_scale^2, divided by that of the twins, whose noise is as stated.
  PooledParameter slope;
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;  // too small or too large refers to the slope
};

// The model for the inliers of a pair is y_i = a + b x_i + noise with x = log noise_scale^2 and
// y = log (r^2 / (1 - h)), r the Sampson distance and h its leverage. The noise is the logarithm of a
// chi-square, so its variance is pi^2 / 2 and gross residuals have little influence. Least squares gives the
// score S = sum (x - mean x) y. An estimator's inlier test cuts off large residuals and so reduces the slope,
// on twins by the same amount. The result is therefore the ratio sum S / sum S_twins, where each pair counts
// the mean of its twins. It is one if the noise is as stated and zero if it does not depend on the scale.
// Interval: 95 %, stats/pooled_scores.h.
SizeReport TestKeyPointSizes(const std::vector<PairAnswers>& answers);

// "grows by 0.4 [0.3, 0.5] of what is stated", "holds: 1 [0.9, 1.1]", ...
std::string DescribeSizeTest(const SizeReport& report);

// S of one pair. NaN if its matches have no scale or nearly the same one, or with fewer than 20 inliers.
double SlopeScore(const MotionProblem& problem, const MotionEstimate& estimate);

}  // namespace rcme
