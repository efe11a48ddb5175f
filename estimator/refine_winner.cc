#include "estimator/refine_winner.h"

#include <fmt/format.h>

namespace rcme {

std::string DivergenceMessage(int num_support, int num_fitted) {
  return fmt::format(
      "the refinement diverged: of {} matches at its start it kept {}, and found no finite optimum",
      num_support, num_fitted);
}

std::string SuccessMessage(int num_inliers, int num_matches) {
  return fmt::format("motion from {} of {} matches", num_inliers, num_matches);
}

}  // namespace rcme
