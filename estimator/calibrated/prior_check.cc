#include "estimator/calibrated/prior_check.h"

#include <algorithm>

namespace rcme {
namespace {

constexpr double kNotableWeight = 1e-4;  // of a motion according to the matches

}  // namespace

double ComputePriorPValue(const MotionPrior& prior, std::span<const MotionBelief> beliefs) {
  double greatest = 0.0;
  bool is_any_notable = false;
  for (const MotionBelief& belief : beliefs) {
    if (!(belief.weight >= kNotableWeight)) continue;
    is_any_notable = true;
    greatest = std::max(greatest, ComputePriorTail(prior, belief.pose, belief.covariance));
  }
  return is_any_notable ? greatest : 1.0;
}

}  // namespace rcme
