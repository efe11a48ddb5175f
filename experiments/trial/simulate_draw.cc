#include "experiments/trial/simulate_draw.h"

#include <fmt/format.h>

#include "estimator/motion_estimate.h"

namespace rcme {

std::string DescribeNotSimulated(std::int64_t num_not_simulated, std::int64_t num_trials) {
  if (num_not_simulated == 0) return {};
  return fmt::format(
      "{} of the {} trials could not be simulated ({}), and no rate counts them; `rcme run` and `rcme "
      "replay` "
      "say why.",
      num_not_simulated, num_trials, StatusName(MotionStatus::kNotSimulated));
}

}  // namespace rcme
