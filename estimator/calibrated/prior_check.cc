#include "estimator/calibrated/prior_check.h"

#include <algorithm>

namespace rcme {
namespace {

constexpr double kNotableWeight = 1e-4;  // of a motion according to the matches

double ComputePValue(const MotionPrior& prior, const MotionBelief& belief) {
  const double exact = ComputePriorTail(prior, belief.pose, belief.covariance);
  const auto& [probability, shift, spread] = belief.errors;
  if (probability == 0.0) return exact;
  const double with_errors = ComputePriorTail(prior, Retract(belief.pose, shift), belief.covariance + spread);
  return (1.0 - probability) * exact + probability * with_errors;
}

}  // namespace

double ComputePriorPValue(const MotionPrior& prior, std::span<const MotionBelief> beliefs) {
  double greatest = 0.0;
  bool is_any_notable = false;
  for (const MotionBelief& belief : beliefs) {
    if (!(belief.weight >= kNotableWeight)) continue;
    is_any_notable = true;
    greatest = std::max(greatest, ComputePValue(prior, belief));
  }
  return is_any_notable ? greatest : 1.0;
}

}  // namespace rcme
