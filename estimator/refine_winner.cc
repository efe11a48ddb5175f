#include "estimator/refine_winner.h"

#include <fmt/format.h>

#include "stats/distributions.h"

namespace rcme {

double ConsistencyThreshold(double significance_level) {
  return ChiSquareQuantile(2, 1.0 - significance_level);
}

std::string DivergenceMessage(int num_support, int num_fitted) {
  return fmt::format("the refinement, begun with {} matches, was left with {} and no finite optimum",
                     num_support, num_fitted);
}

std::string SuccessMessage(int num_inliers, int num_matches) {
  return fmt::format("motion from {} of {} matches", num_inliers, num_matches);
}

}  // namespace rcme
