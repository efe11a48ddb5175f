// Step 4 of rcme_calibrated: matches of a plane are explained by two motions, and calibrated cameras cannot
// tell which is right.
//
// A point X1 of the plane n'X1 = 1 has X2 = (R + t n') X1, so that its rays obey ray2 ~ H ray1, H = R + t n'.
// The other motion comes from the closed-form decomposition of H (Faugeras and Lustman 1988, here in the form
// of Ma, Soatto, Kosecka and Sastry 2004, section 5.3.3, where its middle singular value is one).
#pragma once

#include <optional>
#include <vector>

#include "estimator/calibrated/explanation.h"
#include "estimator/motion_problem.h"

namespace rcme {

// The plane (baselines^-1, in camera 1's frame) that most of the matches with these probabilities lie near,
// by reweighted least squares of their inverse depths n'ray1; nothing where fewer than `least_share` of them
// do.
std::optional<Eigen::Vector3d> FindPlane(const MotionProblem& problem, const RelativePose& pose,
                                         const std::vector<double>& probability, double least_share);

// The other motion and its plane; nothing for a pure rotation, whose H has one decomposition.
std::optional<RelativePose> OtherMotionOfPlane(const RelativePose& pose, const Eigen::Vector3d& plane);

}  // namespace rcme
