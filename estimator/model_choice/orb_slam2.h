// The choice of ORB-SLAM2's initialiser (Mur-Artal, Montiel & Tardos 2015, section IV; `Initializer.cc` of
// the program).
//
// Each match adds to a model's score what its squared error, over sigma^2 and in each of the two images,
// leaves of 5.99; nothing beyond the model's own bound. The error is the distance of the transferred point
// from the point for a homography (bound 5.99, chi-square with 2 degrees of freedom at 95 %), of the point
// from its epipolar line for a fundamental matrix (3.84, with 1). The homography is chosen where S_H / (S_H +
// S_F) exceeds 0.40 in the program (0.45 in the paper): planes, nearly planar scenes and little parallax
// alike.
//
// The errors are of one image against a point without noise, so that right matches exceed the bounds more
// often than in 5 %. F here is that of the essential matrix, since the cameras are known; the program's is of
// eight points.
#pragma once

#include <Eigen/Core>

#include "estimator/motion_problem.h"

namespace rcme {

inline constexpr double kOrbSlam2HomographyShare = 0.40;

// S_H of a homography and S_F of an essential matrix, both between rays.
double OrbSlam2HomographyScore(const MotionProblem& problem, const Eigen::Matrix3d& H);
double OrbSlam2EpipolarScore(const MotionProblem& problem, const Eigen::Matrix3d& E);

}  // namespace rcme
