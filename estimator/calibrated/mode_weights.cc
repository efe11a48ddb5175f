#include "estimator/calibrated/mode_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rcme {
namespace {

constexpr double kExclusive = 0.26, kShared = 1.25, kWidth = 0.75;

}  // namespace

double ModeLogOdds(const Contrast& contrast, double log_det_ratio, double num_explained) {
  const double width = std::clamp(log_det_ratio, -5.0, 5.0) * num_explained / (num_explained + 50.0);
  const double sd = std::sqrt(contrast.shared_variance + 10.0);
  const double beyond_noise = std::max(std::abs(contrast.shared) - 3.0 * sd, 0.0);
  return kExclusive * (contrast.exclusive + std::copysign(beyond_noise, contrast.shared)) +
         kShared * contrast.shared / sd + kWidth * width;
}

double EvidenceOfMotion(const Explanation& mode, const MixtureParameters& mixture, double background) {
  double evidence = -kSearchNats;
  const double w = mixture.inlier_ratio;
  for (size_t i = 0; i < mode.left_out_density.size(); ++i)
    evidence += std::log(w * mode.left_out_density[i] / WrongDensity(mode, i, background) + (1.0 - w));
  return evidence;
}

bool IsSecondMotion(const Contrast& contrast) {
  constexpr int kLeastMatches = 12;
  return contrast.num_clearly_a >= kLeastMatches && contrast.num_clearly_b >= kLeastMatches;
}

double SecondMotionLogOdds(double odds, int num_answer, int num_second) {
  if (!(odds > 0.0) || num_second == 0) return -std::numeric_limits<double>::infinity();
  return std::log(odds) + 3.0 * std::log(static_cast<double>(num_second) / std::max(num_answer, 1));
}

}  // namespace rcme
