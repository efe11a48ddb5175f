// Do residuals grow as the matches' stated noise says?
#pragma once

#include <string>
#include <vector>

#include "experiments/real/truth_free/pair_answers.h"
#include "experiments/real/truth_free/truth_free_verdict.h"
#include "stats/pooled_scores.h"

namespace rcme {

// A slope within this of one is nominal.
inline constexpr double kNominalSlope = 0.25;

struct SizeReport {
  int num_pairs = 0;  // whose matches have a noise_scale
  // Slope of log r^2 on log noise_scale^2 over that of the twins, whose noise is as stated.
  PooledParameter slope;
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;  // too small, too large: of the slope
};

// Within each pair y_i = a + b x_i + noise over its inliers, x = log noise_scale^2, y = log (r^2 / (1 - h)),
// r the Sampson distance and h its leverage; the noise is the logarithm of a chi-square, whose variance pi^2
// / 2 no gross residual moves. Least squares: score S = sum (x - mean x) y, information sum (x - mean x)^2.
// What an estimator takes for an inlier cuts great residuals off, and so the slope; the twins lose as much,
// so that the ratio sum S / sum S_twins, one unit a pair (its twins' mean), is one where the noise is as
// stated and zero where it does not depend on the scale. Interval: stats/pooled_scores.h, 95 %.
SizeReport TestKeyPointSizes(const std::vector<PairAnswers>& answers);

// "grows by 0.4 [0.3, 0.5] of what is stated", "holds: 1 [0.9, 1.1]", ...
std::string DescribeSizeTest(const SizeReport& report);

// S of one pair; NaN where its matches have no scale, or all the same.
double SlopeScore(const MotionProblem& problem, const MotionEstimate& estimate);

}  // namespace rcme
