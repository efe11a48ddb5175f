// Motions of random problems with a covariance: F, its derivatives along the axes of the motion, and the
// model of both.
#pragma once

#include <Eigen/Core>
#include <array>

#include "estimator/point_consistency.h"
#include "tests/test_support/random_problem.h"

namespace rcme {

inline Eigen::Matrix3d ComputeFundamental(const RandomProblem& random) {
  return FundamentalFromEssential(EssentialFromPose(random.pose_true), random.problem.camera1,
                                  random.problem.camera2);
}

inline std::array<Eigen::Matrix3d, 5> FundamentalTangent(const RandomProblem& random) {
  std::array<Eigen::Matrix3d, 5> tangent = EssentialTangent(random.pose_true);
  for (Eigen::Matrix3d& dF : tangent) {
    dF = FundamentalFromEssential(dF, random.problem.camera1, random.problem.camera2);
  }
  return tangent;
}

inline UncertainFundamental ComputeUncertainModel(const RandomProblem& random, const Matrix5d& pose_cov) {
  return UncertainFundamental::From(random.pose_true, pose_cov, random.problem.camera1,
                                    random.problem.camera2)
      .value();
}

// A covariance of about (scale rad)^2 with correlations.
inline Matrix5d RandomPoseCov(double scale, RandomStream& rng) {
  Matrix5d root;
  for (double& x : root.reshaped()) x = scale * rng.Normal();
  return root * root.transpose();
}

}  // namespace rcme
