// How hard a problem is, measured on the truth itself, so that an avoidable failure can be distinguished
// from an impossible problem.
#pragma once

#include <limits>

#include "simulator/observe.h"
#include "simulator/scene.h"
#include "stats/random.h"

namespace rcme {

// Of the true inliers unless said otherwise. Unknown (NaN): not measured, or not defined (too few points, no
// translation).
struct Severity {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  // Area of their convex hull in image 1, share of the image.
  double image_coverage = kUnknown;
  // In image 1 (stats/spatial_pattern.h): 1 random, below 1 clustered; of the outliers in either image.
  double inlier_clark_evans = kUnknown;
  double outlier1_clark_evans = kUnknown;
  double outlier2_clark_evans = kUnknown;
  // Angle at a point between the rays to the two centres: median and 10th percentile.
  double parallax_median_deg = kUnknown;
  double parallax_p10_deg = kUnknown;
  // Root mean square distance from their best plane over that from their centroid: 0 plane, 0.58 round cloud.
  double planarity = kUnknown;
  // Share that one homography explains (homography_share.h).
  double homography_share = kUnknown;
  // Condition number of the information matrix of the motion (5x5, rad).
  double log10_condition = kUnknown;
  // Cramer-Rao bounds: root mean square of the errors of rotation and direction of translation.
  double crb_rotation_deg = kUnknown;
  double crb_direction_deg = kUnknown;
  // Share of uniform mismatches that the true motion would accept at 95 %.
  double chance_inlier_share = kUnknown;
  // Of all matches: wrong, but on the true epipolar line.
  double undetectable_share = kUnknown;
};

// Noise of `sigma_px` per coordinate, normal: what the bounds are for. `rng` draws candidate homographies.
Severity MeasureSeverity(const Scene& scene, const Observation& observation, double sigma_px,
                         RandomStream& rng);

// One list of names and fields for tables and printing; `S` is Severity or const Severity.
template <typename S, typename Visitor>
void VisitSeverity(S& severity, Visitor&& visit) {
  visit("image_coverage", severity.image_coverage);
  visit("inlier_clark_evans", severity.inlier_clark_evans);
  visit("outlier1_clark_evans", severity.outlier1_clark_evans);
  visit("outlier2_clark_evans", severity.outlier2_clark_evans);
  visit("parallax_median_deg", severity.parallax_median_deg);
  visit("parallax_p10_deg", severity.parallax_p10_deg);
  visit("planarity", severity.planarity);
  visit("homography_share", severity.homography_share);
  visit("log10_condition", severity.log10_condition);
  visit("crb_rotation_deg", severity.crb_rotation_deg);
  visit("crb_direction_deg", severity.crb_direction_deg);
  visit("chance_inlier_share", severity.chance_inlier_share);
  visit("undetectable_share", severity.undetectable_share);
}

}  // namespace rcme
