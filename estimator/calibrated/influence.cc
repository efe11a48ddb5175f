#include "estimator/calibrated/influence.h"

#include <algorithm>
#include <cmath>

#include "stats/order_statistic.h"

namespace rcme {
namespace {

constexpr double kOddsAtTwentieth = 4.8, kExponent = 1.9;  // e^c0, c1

}  // namespace

double ProbabilityWrong(double probability_by_residual, double leverage, double leverage_of_twentieth) {
  const double p = std::clamp(probability_by_residual, 1e-4, 1.0 - 1e-4);
  const double ratio = std::max(leverage, 1e-6) / std::max(leverage_of_twentieth, 1e-6);
  const double odds = p / (1.0 - p) * kOddsAtTwentieth * std::pow(ratio, kExponent);
  return odds / (1.0 + odds);
}

std::vector<double> WrongByInfluence(const Mode& mode, const Explanation& explanation) {
  std::vector<double> leverages, wrong(explanation.probability.size(), 0.0);
  for (size_t i = 0; i < wrong.size(); ++i) {
    if (explanation.probability[i] > 0.5) leverages.push_back(explanation.leverage[i]);
  }
  if (leverages.empty()) return wrong;
  const double twentieth = ValueOfRank(19 * leverages.size() / 20, &leverages);
  const MixtureParameters& m = mode.mixture;
  for (size_t i = 0; i < wrong.size(); ++i) {
    if (!(explanation.probability[i] > 0.5)) continue;
    const double outlier = WrongDensity(explanation, i, (1.0 - m.inlier_ratio) * m.outlier_density);
    const double by_residual = outlier / (m.inlier_ratio * explanation.left_out_density[i] + outlier);
    wrong[i] = ProbabilityWrong(by_residual, explanation.leverage[i], twentieth);
  }
  return wrong;
}

}  // namespace rcme
