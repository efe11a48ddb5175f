// The model choice of ORB-SLAM2's initialiser (Mur-Artal, Montiel & Tardos 2015, section IV; `Initializer.cc`
// of the program).
//
// In each of the two images a match adds 5.99 minus its squared error over sigma^2 to the score of a model,
// or nothing if the error exceeds the model's bound. For a homography the error is the distance between the
// transferred point and the point (bound 5.99, chi-square with 2 degrees of freedom at 95 %), for a
// fundamental matrix the distance of the point from its epipolar line (bound 3.84, with 1). The homography is
// chosen if S_H / (S_H + S_F) exceeds 0.40 in the program (0.45 in the paper): in planar or nearly planar
// scenes and with little parallax.
//
// The errors treat the point of the other image as free of noise, so true matches exceed the bounds in more
// than 5 % of cases. F here comes from the essential matrix, since the cameras are known; the program
// computes it from eight points.
#pragma once

#include <Eigen/Core>

#include "estimator/motion_problem.h"

namespace rcme {

inline constexpr double kOrbSlam2HomographyShare = 0.40;

// S_H of a homography and S_F of an essential matrix, each given between rays.
double OrbSlam2HomographyScore(const MotionProblem& problem, const Eigen::Matrix3d& H);
double OrbSlam2EpipolarScore(const MotionProblem& problem, const Eigen::Matrix3d& E);

}  // namespace rcme
