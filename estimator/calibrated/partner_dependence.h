// Do matches that a motion explains lie along their epipolar lines as a point's two images do, or as images
// of points that have nothing to do with each other?
#pragma once

#include <span>

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Standard deviations by which matches speak against partners chosen at random, by two tests.
struct PartnerDependence {
  double order_z = 0.0, rank_z = 0.0;

  double greater_z() const { return order_z > rank_z ? order_z : rank_z; }
};

// Of the first 64 of the matches `some`.
//
// Let a be the cosine of the angle between the translation and the ray in camera 1, turned into camera 2's
// frame, and b that of the ray in camera 2. A residual says nothing of a and b; a point in front of both
// cameras has a < b. Partners chosen at random have a and b that are independent but for that ("quasi-
// independent"), and whatever search chose the motion leaves them so. Two tests:
// - Kendall's tau over the pairs of matches that a < b lets be in either order (Tsai 1990, Biometrika
// 77:169):
//   of points seen under a large parallax, a and b rise together;
// - the rank of a match's b among those of the first 128 matches of the problem, right or wrong, that are
//   greater than its a: under a small parallax it is one of the next.
// Where partners are random, each is about standard normal; the second takes the b of the problem as fixed.
PartnerDependence FindPartnerDependence(const MotionProblem& problem, const RelativePose& pose,
                                        std::span<const size_t> some);

}  // namespace rcme
