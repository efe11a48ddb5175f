// The entropy score of a hypothesis's inlier set, and the test of its quality.
#pragma once

#include "estimator/ransac_options.h"

namespace rcme {

// The score of a hypothesis from one pass over the matches, in constant memory.
struct InlierScore {
  int num_inliers = 0;        // n_j
  double mean_entropy = 0.0;  // psi_j (eq. 16): the mean, not the paper's "L1 norm", which would make
                              // negative entropies positive
  double sum_squares = 0.0;   // sum (h - psi)^2, by Welford's update
  double negative_log_likelihood = 0.0;  // predictive, over all matches

  // Adds the entropy of one inlier to psi and to the sum of squares (eq. 16).
  void AddInlier(double entropy) {
    ++num_inliers;
    const double step = entropy - mean_entropy;
    mean_entropy += step / num_inliers;
    sum_squares += step * (entropy - mean_entropy);
  }
};

// The field of an InlierScore by which an estimator chooses among its candidates.
enum class DecidingScore {
  kNumInliers,   // most inliers, as in RANSAC
  kMeanEntropy,  // least mean entropy (eq::model_select_entropy)
  kCost,         // least negative_log_likelihood
};
// The field by which the option `selection` chooses.
DecidingScore FindDecidingScore(Selection selection);
bool IsBetter(const InlierScore& a, const InlierScore& b, DecidingScore decides);

// Z_j = (psi - mu) / (s / sqrt(n_j)) (eq. 18). Special cases: plus infinity without inliers; with one inlier
// or s = 0 the limit s -> 0, which is minus infinity if psi <= mu, else plus infinity.
double ZStatistic(const InlierScore& score, double mu);

// Whether H0 "psi > mu" is rejected (eq::inlier-quality-test). With `normal_quantile` = Phi^-1(1 - alpha):
// Z_j <= normal_quantile as printed (eq. 19), Z_j <= -normal_quantile at level alpha.
bool PassesQualityTest(double z, double normal_quantile, QualityTest test);

}  // namespace rcme
