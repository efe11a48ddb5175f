// The inlier set of one hypothesis, its entropy score, and the test of its quality.
#pragma once

#include "estimator/ransac_options.h"

namespace rcme {

// What one pass over the matches leaves of a hypothesis; nothing per point is stored.
struct InlierScore {
  int num_inliers = 0;        // n_j
  double mean_entropy = 0.0;  // psi_j (eq. 16), a mean: the paper's "L1 norm" would turn negative entropies
                              // positive
  double sum_squares = 0.0;   // sum (h - psi)^2, Welford
  double negative_log_likelihood = 0.0;  // of all matches, predictive

  // With one more entropy: psi and the sum of squares (eq. 16).
  void AddInlier(double entropy) {
    ++num_inliers;
    const double step = entropy - mean_entropy;
    mean_entropy += step / num_inliers;
    sum_squares += step * (entropy - mean_entropy);
  }
};

// The number of an InlierScore by which an estimator chooses among its candidates.
enum class DecidingScore {
  kNumInliers,   // the most, as RANSAC
  kMeanEntropy,  // the least (eq::model_select_entropy)
  kCost,         // the least negative_log_likelihood
};
// What the option `selection` chooses by.
DecidingScore FindDecidingScore(Selection selection);
bool IsBetter(const InlierScore& a, const InlierScore& b, DecidingScore decides);

// Z_j = (psi - mu) / (s / sqrt(n_j)) (eq. 18). Fewer than two inliers, or s = 0: minus infinity where psi <=
// mu, else plus infinity, the limit s -> 0. No inlier at all: plus infinity.
double ZStatistic(const InlierScore& score, double mu);

// Whether H0 "psi > mu" is rejected (eq::inlier-quality-test): Z_j <= Phi^-1(1 - alpha) as printed (eq. 19);
// `normal_quantile` is Phi^-1(1 - alpha).
bool PassesQualityTest(double z, double normal_quantile, QualityTest test);

}  // namespace rcme
