#pragma once

#include <Eigen/Core>
#include <span>

#include "simulator/view_pair.h"
#include "stats/random.h"

namespace rcme {

// The greatest share of the points that one homography explains: points on one plane, or all whose parallax
// is negligible. A point counts if the homography maps its exact first image to within `max_distance_px` of
// its exact second image. Candidates are the homography of the plane at infinity and those of 64 planes
// through three random points each. The result is a lower bound; if the true share is s, it is reached with
// probability 1 - (1 - s^3)^64 or more (0.9996 at s = 0.49; 0.82 at 0.3). At most 200 points, drawn at
// random, are tested.
double HomographyShare(const ViewPair& view, std::span<const Eigen::Vector3d> points_in_cam1,
                       double max_distance_px, RandomStream& rng);

}  // namespace rcme
