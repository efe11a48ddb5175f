// The covariance of a least-squares motion whose residuals are correlated within groups of matches.
//
// Let a motion minimise 1/2 sum r_i^2 over its matches. If a group c of them is left out, it moves by
// (A - A_c)^-1 s_c to first order, with
//
//   A = sum J_i' J_i    information of all matches, 5x5; A_c of the group; J_i = g_p / (sigma |J|), 1x5
//   s_c = sum J_i' r_i  score of the group, 5x1; r_i = g / (sigma |J|)
//
// If errors of different groups are independent, C = sum_c (A - A_c)^-1 s_c s_c' (A - A_c)^-1. This is the
// sandwich that leaves out whole groups (CR3, Bell and McCaffrey 2002; to first order a delete-one-group
// jackknife). If each match is a group of its own, it is HC3 (MacKinnon and White 1985), A^-1 sum (r_i / (1 -
// h_i))^2 J_i' J_i A^-1. sigma cancels.
#pragma once

#include <span>
#include <vector>

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"

namespace rcme {

struct MatchScores {
  std::vector<Vector5d> rows;     // J_i', 5x1
  std::vector<double> residuals;  // r_i
  std::vector<Correspondence> matches;
  std::vector<Eigen::Vector4d> normals;  // derivatives of g by both points, of length 1
  Matrix5d information = Matrix5d::Zero();
};
MatchScores ScoreFitted(const MotionProblem& problem, std::span<const int> fitted, const RelativePose& pose);

// Computes C. `groups` holds the group 0, 1, ... of each score. Returns NaN if A is not positive definite. A
// group with more than 0.95 of the information along a direction counts as if it had 0.95.
Matrix5d ClusteredCovariance(const MatchScores& scores, std::span<const int> groups);

// Makes each match a group of its own.
std::vector<int> Separate(size_t num_matches);
// Groups the matches that share a key point: they lie within `radius_px` of each other in image 1 or in image
// 2, directly or through other matches.
std::vector<int> KeyPointGroups(const std::vector<Correspondence>& matches, double radius_px);
// Groups the matches by blocks of image 1, per_side x per_side of them.
std::vector<int> BlockGroups(const Camera& camera1, const std::vector<Correspondence>& matches, int per_side);

}  // namespace rcme
