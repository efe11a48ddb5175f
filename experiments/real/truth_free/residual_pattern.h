// What the residuals of some pairs have in common: their size, their tails, their correlation.
#pragma once

#include <vector>

#include "experiments/real/truth_free/residual_correlation.h"

namespace rcme {

struct ResidualPattern {
  double sigma_px = 0.0;    // geometric mean; NaN without an answer
  double tail_ratio = 0.0;  // 95 % point over the median of |r| / sigma, all pairs together
  ResidualProducts products;
};

// Of the inliers: Sampson distance over the noise of the answer (EstimateNoise) and over the match's own
// noise scale.
std::vector<double> ResidualSizes(const MotionProblem& problem, const MotionEstimate& estimate);

// Of the answers to some pairs, one after the other; refusals are skipped.
class PatternSum {
 public:
  void Add(const MotionProblem& problem, const MotionEstimate& estimate);
  ResidualPattern Take() const;

 private:
  double sum_log_sigma_ = 0.0, num_answers_ = 0.0;
  std::vector<double> sizes_;
  ResidualProducts products_;
};

}  // namespace rcme
