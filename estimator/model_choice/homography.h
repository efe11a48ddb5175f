// Homographies between rays: ray2 ~ H ray1, third components 1. Of the plane m'X = 1 (camera 1's frame) H = R
// + t m' up to scale, of a rotation without translation H = R. The sign is such that (H ray1)_z > 0 in front
// of camera 2.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "estimator/match_whitening.h"
#include "estimator/motion_problem.h"

namespace rcme {

struct RayMatch {
  Eigen::Vector3d ray1, ray2;
};

// All matches of a problem as rays, and the standard deviations of their coordinates.
struct RayMatches {
  explicit RayMatches(const MotionProblem& problem);
  std::vector<RayMatch> matches;
  RayScale noise;
};

// The homography of four matches: with A, B such that their columns are the first three rays of each image,
// scaled so that they sum to the fourth, H = B A^-1. It is the null vector of the direct linear transform's
// eight equations. Nothing where three of the points lie on one line in an image, or where the four do not
// lie on the same side of the line that H takes to infinity, as points in front of both cameras do.
using FourMatches = std::array<RayMatch, 4>;
std::optional<Eigen::Matrix3d> HomographyOfFour(const FourMatches& sample);

// The rotation of two matches, least squares over the rays' directions (Kabsch 1976). Nothing where the two
// are one.
using TwoMatches = std::array<RayMatch, 2>;
std::optional<Eigen::Matrix3d> RotationOfTwo(const TwoMatches& sample);

// e = x2 - h(x1), h the image of H x1. Both points carry noise, so e has the covariance C = S2 + J S1 J', J =
// dh/dx1 (2x2) and S1, S2 those of the two points: d2 = e' C^-1 e is the squared distance of the match from
// the homography's variety over sigma^2, to first order, and chi-square with 2 degrees of freedom for a right
// match.
struct Transfer {
  Eigen::Vector2d e, h;         // rays
  double depth = 0.0;           // (H ray1)_z
  Eigen::Matrix2d information;  // C^-1
  double d2 = 0.0;
};
// Nothing where the homography takes the point behind camera 2.
std::optional<Transfer> EvaluateTransfer(const Eigen::Matrix3d& H, const RayMatch& match,
                                         const RayScale& noise);

// d2 of each match; infinite where there is none.
std::vector<double> SquaredTransfers(const RayMatches& all, const Eigen::Matrix3d& H);

// sum min(d2, threshold) over all matches; once it is beyond `enough`, some number beyond that.
double TruncatedCost(const RayMatches& all, const Eigen::Matrix3d& H, double threshold, double enough);

// From `start` to a maximum-likelihood fit to the matches within the threshold, until they do not change any
// more. Never of a greater cost than `start`.
Eigen::Matrix3d RefineHomography(const RayMatches& all, const Eigen::Matrix3d& start, double threshold);

}  // namespace rcme
