// Step 4 of rcme_calibrated: two motions explain the matches of a plane, and calibrated cameras cannot
// distinguish them.
//
// A point X1 of the plane n'X1 = 1 has X2 = (R + t n') X1, so that its rays satisfy ray2 ~ H ray1, H = R + t
// n'. The other motion comes from the closed-form decomposition of H (Faugeras and Lustman 1988, here in the
// form of Ma, Soatto, Kosecka and Sastry 2004, section 5.3.3, for H scaled to a middle singular value of
// one).
#pragma once

#include <optional>
#include <vector>

#include "estimator/motion_problem.h"

namespace rcme {

// In camera 1's frame.
struct VisiblePlane {
  Eigen::Vector3d n;     // n'X = 1, baselines^-1
  Eigen::Vector3d ray1;  // the mean ray to its points
};

// The plane near which most of the matches lie, by reweighted least squares of their inverse depths n'ray1.
// `probability`: that a match is an inlier. Nullopt if less than `least_share` of the inliers lie near it.
std::optional<VisiblePlane> FindPlane(const MotionProblem& problem, const RelativePose& pose,
                                      const std::vector<double>& probability, double least_share);

// The other motion that explains the plane; nullopt for a pure rotation, whose H has only one decomposition.
// The translation has the sign with which camera 1 sees the plane's points in front of it.
std::optional<RelativePose> OtherMotionOfPlane(const RelativePose& pose, const VisiblePlane& plane);

}  // namespace rcme
