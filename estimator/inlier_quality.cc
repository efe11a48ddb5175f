#include "estimator/inlier_quality.h"

#include <cmath>

#include "stats/constants.h"

namespace rcme {

DecidingScore FindDecidingScore(Selection selection) {
  return selection == Selection::kMeanEntropy ? DecidingScore::kMeanEntropy : DecidingScore::kCost;
}

// By mean entropy, the smaller is better (eq::model_select_entropy).
bool IsBetter(const InlierScore& a, const InlierScore& b, DecidingScore decides) {
  switch (decides) {
    case DecidingScore::kNumInliers:
      return a.num_inliers > b.num_inliers;
    case DecidingScore::kMeanEntropy:
      return a.mean_entropy < b.mean_entropy;
    case DecidingScore::kCost:
      break;
  }
  return a.negative_log_likelihood < b.negative_log_likelihood;
}

// Z_j (eq. 18), with s_j, the standard deviation of the entropies (eq. 16).
double ZStatistic(const InlierScore& score, double mu) {
  if (score.num_inliers == 0) return kInfinity;
  const double n = score.num_inliers;
  const double s = score.num_inliers > 1 ? std::sqrt(score.sum_squares / (n - 1.0)) : 0.0;
  if (!(s > 0.0)) return score.mean_entropy <= mu ? -kInfinity : kInfinity;
  return (score.mean_entropy - mu) / (s / std::sqrt(n));
}

// eq::inlier-quality-test, with the quantile as printed (eq. 19) or of the stated level.
bool PassesQualityTest(double z, double normal_quantile, QualityTest test) {
  return z <= (test == QualityTest::kAsPrinted ? normal_quantile : -normal_quantile);
}

}  // namespace rcme
