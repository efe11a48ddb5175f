// Tests whether the matches that a motion explains lie along their epipolar lines as two images of one point
// do, or as images of unrelated points.
#pragma once

#include <span>

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Evidence against randomly chosen partners by two tests, in standard deviations.
struct PartnerDependence {
  double order_z = 0.0, rank_z = 0.0;

  double greater_z() const { return order_z > rank_z ? order_z : rank_z; }
};

// Tests the first 64 of the matches `some`.
//
// Let a be the cosine of the angle between the translation and the ray in camera 1, rotated into camera 2's
// frame, and b that of the ray in camera 2. A residual does not depend on a and b. A point in front of both
// cameras has a < b. For partners chosen at random, a and b are independent except for this
// ("quasi-independent"), and a search for the motion does not change that. There are two tests:
// - Kendall's tau over the pairs of matches that could be in either order given a < b (Tsai 1990, Biometrika
//   77:169). For points with a large parallax, a and b increase together.
// - The rank of a match's b among those that are greater than its a, of the first 128 matches of the problem,
//   right or wrong. With a small parallax its b is one of the next.
//
// For random partners, order_z is about standard normal. The second test takes the values of b in the problem
// as fixed, and its variance is that of independent ranks. But no two matches have the same partner, so that
// rank_z varies less: if all a are less than all b, its variance is (N - n) / (N - 1) for n tested matches of
// N, and 0 if all are tested, whose ranks are a permutation. The fitted constants are for this form.
PartnerDependence FindPartnerDependence(const MotionProblem& problem, const RelativePose& pose,
                                        std::span<const size_t> some);

}  // namespace rcme
