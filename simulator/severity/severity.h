// How hard a problem is, measured on the truth itself, so that a failure can be told from an impossible
// problem.
#pragma once

#include <limits>

#include "simulator/observe.h"
#include "simulator/scene.h"
#include "stats/random.h"

namespace rcme {

// Of the true inliers unless said otherwise. NaN: not defined (too few points, no translation).
struct Severity {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double image_coverage = kUnknown;      // area of their convex hull in image 1, share of the image
  double inlier_clark_evans = kUnknown;  // in image 1 (stats/spatial_pattern.h): 1 random, below 1 clustered
  double outlier1_clark_evans = kUnknown;  // of the outliers in image 1
  double outlier2_clark_evans = kUnknown;  // of the outliers in image 2
  double parallax_median_deg = kUnknown;   // angle at the point between the rays to the two centres
  double parallax_p10_deg = kUnknown;      // its 10th percentile
  double planarity =
      0.0;  // rms distance from their best plane / from their centroid: 0 plane, 0.58 round cloud
  double homography_share = kUnknown;   // share that one homography explains (homography_share.h)
  double log10_condition = kUnknown;    // of the information matrix of the motion (5x5, rad)
  double crb_rotation_deg = kUnknown;   // Cramer-Rao bound: root mean square of the rotation error
  double crb_direction_deg = kUnknown;  // ... of the error of the direction of translation
  double chance_inlier_share =
      kUnknown;  // share of uniform mismatches that the true motion would accept at 95 %
  double undetectable_share = kUnknown;  // of all matches: wrong, but on the true epipolar line
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
