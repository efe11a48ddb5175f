// Homographies between rays: ray2 ~ H ray1, third components 1. For the plane m'X = 1 (camera 1's frame) H =
// R + t m' up to scale, for a pure rotation H = R. The sign is such that (H ray1)_z > 0 in front of camera 2.
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

// The homography of four matches. With A, B the matrices whose columns are the first three rays of each
// image, scaled so that they sum to the fourth, H = B A^-1. It is the null vector of the eight equations of
// the direct linear transform. nullopt if three points lie on one line in an image, or if the four do not lie
// on the same side of the line that H takes to infinity, as points in front of both cameras do.
using FourMatches = std::array<RayMatch, 4>;
std::optional<Eigen::Matrix3d> HomographyOfFour(const FourMatches& sample);

// The rotation of two matches by least squares over the rays' directions (Kabsch 1976). nullopt if the two
// coincide.
using TwoMatches = std::array<RayMatch, 2>;
std::optional<Eigen::Matrix3d> RotationOfTwo(const TwoMatches& sample);

// e = x2 - h(x1), h the image of H x1. Both points carry noise, so e has the covariance C = S2 + J S1 J', J =
// dh/dx1 (2x2) and S1, S2 the covariances of the two points. To first order d2 = e' C^-1 e is the squared
// distance of the match from the variety of the homography over sigma^2, chi-square with 2 degrees of freedom
// for a true match.
struct Transfer {
  Eigen::Vector2d e, h;         // rays
  double depth = 0.0;           // (H ray1)_z
  Eigen::Matrix2d information;  // C^-1
  double d2 = 0.0;
};
// nullopt if the homography takes the point behind camera 2.
std::optional<Transfer> EvaluateTransfer(const Eigen::Matrix3d& H, const RayMatch& match,
                                         const RayScale& noise);

// d2 of each match; infinite behind camera 2.
std::vector<double> SquaredTransfers(const RayMatches& all, const Eigen::Matrix3d& H);

// sum min(d2, threshold) over all matches. Stops early once the sum exceeds `enough`; the result is then only
// known to exceed it.
double TruncatedCost(const RayMatches& all, const Eigen::Matrix3d& H, double threshold, double enough);

// A maximum-likelihood fit from `start` to the matches within the threshold, repeated until these do not
// change. Its cost never exceeds that of `start`.
Eigen::Matrix3d RefineHomography(const RayMatches& all, const Eigen::Matrix3d& start, double threshold);

}  // namespace rcme
