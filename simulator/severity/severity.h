// The difficulty of a problem, measured on the ground truth. It separates avoidable failures from impossible
// problems.
#pragma once

#include <limits>

#include "simulator/observe.h"
#include "simulator/scene.h"
#include "stats/random.h"

namespace rcme {

// Computed from the true inliers unless experiments/trial/severity_columns.h, which defines each number, says
// otherwise. NaN: not measured, or not defined (too few points, no translation).
struct Severity {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  double image_coverage = kUnknown;
  double inlier_clark_evans = kUnknown;  // stats/spatial_pattern.h
  double outlier1_clark_evans = kUnknown;
  double outlier2_clark_evans = kUnknown;
  double parallax_median_deg = kUnknown;
  double parallax_p10_deg = kUnknown;
  double planarity = kUnknown;         // 0.58: a round cloud
  double homography_share = kUnknown;  // homography_share.h
  double log10_condition = kUnknown;
  double crb_rotation_deg = kUnknown;
  double crb_direction_deg = kUnknown;
  double chance_inlier_share = kUnknown;
  double undetectable_share = kUnknown;
};

// `sigma_px`: normal noise per coordinate, on which the Cramer-Rao bounds are based. `rng` draws candidate
// homographies.
Severity MeasureSeverity(const Scene& scene, const Observation& observation, double sigma_px,
                         RandomStream& rng);

}  // namespace rcme
