#include "estimator/calibrated/mode_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rcme {
namespace {

// log Phi(-z) / Phi(z), z >= 0.
double NormalLogOdds(double z) {
  const double tail = 0.5 * std::erfc(z / std::sqrt(2.0));
  // Beyond 25 the tail is phi(z) / z to a thousandth.
  if (z > 25.0) return -0.5 * z * z - std::log(z) - 0.9189385332046727;
  return std::log(tail) - std::log1p(-tail);
}

}  // namespace

double RivalLogOdds(const Contrast& contrast, double log_det_ratio) {
  const double D = contrast.exclusive + 0.5 * contrast.shared + 0.5 * log_det_ratio;
  if (!(D > 0.0)) return kGreatestLogOdds;
  const double z = D / std::sqrt(contrast.variance + 1.0);
  return std::min(std::max(NormalLogOdds(z), -D), kGreatestLogOdds);
}

double EvidenceOfMotion(const Explanation& mode, const MixtureParameters& mixture, double background) {
  double evidence = -kSearchNats;
  const double w = mixture.inlier_ratio;
  for (const double density : mode.left_out_density)
    evidence += std::log(w * density / background + (1.0 - w));
  return evidence;
}

double SecondMotionLogOdds(double odds, int num_answer, int num_second) {
  if (!(odds > 0.0) || num_second == 0) return -std::numeric_limits<double>::infinity();
  return std::log(odds) + 1.5 * std::log(static_cast<double>(num_second) / std::max(num_answer, 1));
}

}  // namespace rcme
