// Matches of images that lenses distort, for estimators, which know pinhole cameras alone.
//
// A key point's noise, of covariance sigma^2 I in the image as it was taken, is sigma^2 J J' in that of the
// pinhole, J = d undistorted / d distorted: at 60 deg from the axis of an equidistant fisheye it is four
// times as large along the radius and 1.7 times across it. An estimator takes one number a match, its
// noise_scale, for both images. Which?
//
// The residual e = x2' F x1 has, to first order, the variance sigma^2 (g1' J1 J1' g1 + g2' J2 J2' g2), g1 and
// g2 its gradients by the two points; an estimator takes it for (s sigma)^2 (|g1|^2 + |g2|^2). Of the shape
// of J J' the area is kept, J J' ~ |det J| I: the geometric mean over the directions in which g may lie. Then
// s^2 = (|det J1| |g1|^2 + |det J2| |g2|^2) / (|g1|^2 + |g2|^2), and as g depends on the motion that is
// sought but is equally long in both images where focal lengths and depths are (g1 = F' x2, g2 = F x1),
//
//   s^2 = (|det J1| + |det J2|) / 2,
//
// the mean square of both images' scales. What this costs in the coverage of a covariance is measured in
// tests/estimator/undistortion_test.cc.
#pragma once

#include <optional>
#include <vector>

#include "estimator/geometry/lens.h"
#include "estimator/motion_problem.h"

namespace rcme {

// A match in pinhole pixels, and the standard deviation of its noise over that in distorted pixels.
struct UndistortedMatch {
  Correspondence match;
  double noise_ratio;
};
// Nothing where a lens sends no ray to the pixel (Undistort).
std::optional<UndistortedMatch> UndistortMatch(const Lens& lens1, const Lens& lens2,
                                               const Correspondence& distorted);

struct UndistortedProblem {
  // Pinhole cameras of the lenses' K and the matches that have rays. sigma_px is that of the median match, of
  // which noise_scale are multiples again.
  MotionProblem problem;
  std::vector<size_t> kept;  // of each match, which of the distorted ones it was
};
// The same problem with pinhole cameras. `distorted`: its matches, sigma_px and noise_scale are those of the
// images as they were taken; its cameras are not looked at. Without a lens in either camera it stays as it
// is.
UndistortedProblem UndistortProblem(const Lens& lens1, const Lens& lens2, MotionProblem distorted);

}  // namespace rcme
