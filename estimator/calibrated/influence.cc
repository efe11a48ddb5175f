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

namespace {

// Calls visit(i, p, h, q) with the arguments of ProbabilityWrong for each match i that the mode explains.
template <typename Visit>
void VisitExplained(const Mode& mode, const Explanation& explanation, const Visit& visit) {
  std::vector<double> leverages;
  leverages.reserve(explanation.probability.size());
  for (size_t i = 0; i < explanation.probability.size(); ++i) {
    if (explanation.probability[i] > 0.5) leverages.push_back(explanation.leverage[i]);
  }
  if (leverages.empty()) return;
  const double twentieth = ValueOfRank(19 * leverages.size() / 20, &leverages);
  const MixtureParameters& m = mode.mixture;
  for (size_t i = 0; i < explanation.probability.size(); ++i) {
    if (!(explanation.probability[i] > 0.5)) continue;
    const double outlier = WrongDensity(explanation, i, (1.0 - m.inlier_ratio) * m.outlier_density);
    const double by_residual = outlier / (m.inlier_ratio * explanation.left_out_density[i] + outlier);
    visit(i, by_residual, explanation.leverage[i], twentieth);
  }
}

}  // namespace

std::vector<double> WrongByInfluence(const Mode& mode, const Explanation& explanation) {
  std::vector<double> wrong(explanation.probability.size(), 0.0);
  VisitExplained(mode, explanation,
                 [&](size_t i, double p, double h, double q) { wrong[i] = ProbabilityWrong(p, h, q); });
  return wrong;
}

std::vector<size_t> ListWrongByInfluence(const Mode& mode, const Explanation& explanation) {
  // Up to h = q, the odds of being wrong are at most 4.8 p / (1 - p): below one if p is below 0.17.
  constexpr double kSurelyRight = 0.17;
  static_assert(kSurelyRight * kOddsAtTwentieth < 0.99 * (1.0 - kSurelyRight));
  std::vector<size_t> wrong;
  VisitExplained(mode, explanation, [&](size_t i, double p, double h, double q) {
    if (h <= q && p < kSurelyRight) return;
    if (ProbabilityWrong(p, h, q) >= 0.5) wrong.push_back(i);
  });
  return wrong;
}

}  // namespace rcme
