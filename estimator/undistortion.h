// Converts the matches of images with lens distortion for estimators, which take pinhole cameras only.
//
// Key point noise of covariance sigma^2 I in the distorted image becomes sigma^2 J J' in the pinhole image, J
// = d undistorted / d distorted. At 60 deg from the axis of an equidistant fisheye its standard deviation is
// four times as large along the radius and 1.7 times across it. An estimator, however, takes a single number
// per match, its noise_scale s, for both images. It is derived as follows.
//
// To first order the residual e = x2' F x1 has the variance sigma^2 (g1' J1 J1' g1 + g2' J2 J2' g2), g1 and
// g2 its gradients with respect to the two points. The estimator assumes (s sigma)^2 (|g1|^2 + |g2|^2).
// Replace J J' by |det J| I, of the same area: its geometric mean over the directions of g. Then s^2 = (|det
// J1| |g1|^2 + |det J2| |g2|^2) / (|g1|^2 + |g2|^2). The gradients g1 = F' x2 and g2 = F x1 depend on the
// unknown motion, but are equally long if focal lengths and depths are equal in both images. This gives
//
//   s^2 = (|det J1| + |det J2|) / 2,
//
// the mean square of the two images' scales. tests/estimator/undistortion_test.cc measures what the
// approximation costs in the coverage of a covariance.
#pragma once

#include <optional>
#include <vector>

#include "estimator/geometry/lens.h"
#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// A match in pinhole pixels, and the ratio of its noise's standard deviation in pinhole pixels to that in
// distorted pixels (s above).
struct UndistortedMatch {
  Correspondence match;
  double noise_ratio;
};
// nullopt if Undistort has no ray for one of the two pixels, or the noise ratio is not positive and finite.
std::optional<UndistortedMatch> UndistortMatch(const Lens& lens1, const Lens& lens2,
                                               const Correspondence& distorted);

struct UndistortedProblem {
  // The pinhole cameras with the lenses' K, and the matches that have rays. sigma_px is that of the match of
  // median noise; noise_scale is relative to it. `undistortion` is set if there is a lens.
  MotionProblem problem;
  std::vector<size_t> kept;  // for each match, its index among the distorted ones
};
// Converts the problem to pinhole cameras. The matches, sigma_px and noise_scale of `distorted` belong to the
// distorted images; its cameras are ignored. If both lenses are pinholes, the matches stay unchanged.
UndistortedProblem UndistortProblem(const Lens& lens1, const Lens& lens2, MotionProblem distorted);

// Makes an estimate of the undistorted problem one of the distorted matches: noise levels in the pixels of
// the images, inliers and probabilities by the place of a match among all `num_distorted`. A match that has
// no ray is no inlier, with a probability of 0. `kept` as above.
void RestoreDistorted(const MotionProblem& problem, const std::vector<size_t>& kept, size_t num_distorted,
                      MotionEstimate* estimate);

}  // namespace rcme
