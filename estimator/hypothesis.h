#pragma once

#include <array>
#include <optional>

#include "estimator/motion_problem.h"
#include "estimator/solvers/eight_point.h"
#include "estimator/uncertainty/motion_covariance.h"

namespace rcme {

using Sample = std::array<int, EightPoint::kSampleSize>;  // S_j, indices of distinct matches

// The model of one iteration: f_j and p_j, and their covariances once PropagateCovariance has run.
//
// `pose` is one of the four motions of E; which one does not matter to any test in the loop, because all four
// have the same F up to its sign and the same tangent. Cheirality is decided for the winner alone.
struct Hypothesis {
  Sample sample{};
  LinearModel linear;              // f_j (eq::model_instantiate)
  EssentialProjection projection;  // E nearest to f_j
  RelativePose pose;               // p_j (eq::motion_estimate), up to cheirality
  Eigen::Matrix3d F = Eigen::Matrix3d::Zero();
  Matrix9d f_cov = Matrix9d::Zero();     // Sigma_f
  Matrix5d pose_cov = Matrix5d::Zero();  // Sigma_p (eq::cov_p)
};

// f_j and p_j from the sample; nothing if the sample is degenerate.
std::optional<Hypothesis> InstantiateModel(const MotionProblem& problem, const Sample& sample);

// Fills f_cov and pose_cov from the noise of the sample.
void PropagateCovariance(const MotionProblem& problem, Hypothesis* hypothesis);

}  // namespace rcme
