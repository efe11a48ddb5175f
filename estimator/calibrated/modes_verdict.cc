#include "estimator/calibrated/modes_verdict.h"

namespace rcme {

ModeWeights ReweighModes(ModeWeights weights, const ModesVerdict& verdict) {
  if (verdict.failure_probability == verdict.by_modes) return weights;
  const bool is_greater = verdict.failure_probability > verdict.by_modes;
  const double factor = is_greater ? (1.0 - verdict.failure_probability) / (1.0 - verdict.by_modes)
                                   : verdict.failure_probability / verdict.by_modes;
  double same = 0.0, rivals = 0.0;
  for (size_t i = 0; i < weights.of_modes.size(); ++i)
    (weights.is_rival[i] ? rivals : same) += weights.of_modes[i];
  weights.of_no_motion = is_greater ? 1.0 - factor * (same + rivals) : factor * weights.of_no_motion;
  const double of_same = is_greater ? factor : (1.0 - factor * rivals - weights.of_no_motion) / same;
  for (size_t i = 0; i < weights.of_modes.size(); ++i)
    weights.of_modes[i] *= weights.is_rival[i] ? factor : of_same;
  return weights;
}

}  // namespace rcme
