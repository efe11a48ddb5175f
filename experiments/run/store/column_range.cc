#include "experiments/run/store/column_range.h"

#include <map>

namespace rcme {

ColumnRange RangeOf(const std::string& column) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kFinite = std::numeric_limits<double>::max();
  static const std::map<std::string, ColumnRange> ranges = {
      {"weight", {0.0, kFinite, false}},
      {"seconds", {0.0, kFinite, false}},
      {"num_inliers_true", {0.0, kFinite}},
      {"num_matches", {0.0, kInfinity}},
      {"num_inliers", {0.0, kInfinity}},
      {"rotation_error_deg", {0.0, kInfinity}},
      {"direction_error_deg", {0.0, kInfinity}},
      {"inlier_precision", {0.0, 1.0}},
      {"inlier_recall", {0.0, kInfinity}},  // beyond 1 for an estimator that names a match twice
      {"parallax_median_deg", {0.0, 180.0}},
      {"parallax_p10_deg", {0.0, 180.0}},
      {"crb_rotation_deg", {0.0, kInfinity}},
      {"crb_direction_deg", {0.0, kInfinity}},
      {"homography_share", {0.0, 1.0}},
      {"chance_inlier_share", {0.0, kInfinity}},
      {"undetectable_share", {0.0, 1.0}},
      {"failure_probability", {0.0, 1.0}},
      {"sigma_estimated_px", {0.0, kInfinity}},
      {"sigma_estimated_sd_px", {0.0, kInfinity}},
      {"inlier_brier", {0.0, 1.0}},
  };
  const auto found = ranges.find(column);
  return found == ranges.end() ? ColumnRange() : found->second;
}

}  // namespace rcme
