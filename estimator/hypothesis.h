// A hypothesis of the loop: the model of a minimal sample, its motion and the covariance of that motion.
#pragma once

#include <optional>

#include "estimator/motion_problem.h"
#include "estimator/point_consistency.h"
#include "estimator/sample.h"
#include "estimator/solvers/minimal_solver.h"

namespace rcme {

// f_j and p_j; PropagateCovariance fills their covariances.
//
// `pose` is one of the four motions of E. All four have the same F up to its sign and the same tangent, so no
// test of the loop depends on which one it is. Cheirality is decided for the winner alone.
template <typename SolverT>
struct Hypothesis {
  using Solver = SolverT;
  static constexpr int kSampleSize = Solver::kSampleSize;
  // With at most five equations pose_cov has a square root of kSampleSize columns (pose_factor).
  static constexpr bool kHasFactor = kSampleSize <= 5;

  HypothesisId id;
  typename Solver::Model model;    // f_j (eq::model_instantiate)
  EssentialProjection projection;  // E nearest to f_j; f_j itself if the solver is exact for the motion
  RelativePose pose;               // p_j (eq::motion_estimate), up to cheirality
  Eigen::Matrix3d F = Eigen::Matrix3d::Zero();
  Matrix9d f_cov = Matrix9d::Zero();     // Sigma_f, rank min(kSampleSize, 8)
  Matrix5d pose_cov = Matrix5d::Zero();  // Sigma_p (eq::cov_p), rank min(kSampleSize, 5)
  // L = J_p G D^(1/2) in the first kSampleSize columns, L L' = Sigma_p; filled only if kHasFactor.
  Matrix5d pose_factor = Matrix5d::Zero();
};

// The rays K^-1 [x; 1] of a sample in both cameras.
template <typename Solver>
struct SampleRays {
  typename Solver::Rays first, second;

  SampleRays(const MotionProblem& problem, const Sample& sample);
};

// p_j of a model f_j; nullopt if f_j does not determine the direction of translation.
template <typename Solver>
std::optional<Hypothesis<Solver>> HypothesisFromModel(const MotionProblem& problem, const HypothesisId& id,
                                                      const typename Solver::Model& model);

// f_j and p_j of every model of the sample; empty if the sample is degenerate. The k-th hypothesis has the id
// (sample, k).
template <typename Solver>
ModelList<Hypothesis<Solver>, Solver::kMaxModels> InstantiateModels(const MotionProblem& problem,
                                                                    const Sample& sample);

// The hypothesis with this id, or nullopt.
template <typename Solver>
std::optional<Hypothesis<Solver>> InstantiateModel(const MotionProblem& problem, const HypothesisId& id);

// Fills f_cov and pose_cov from the noise of the sample.
template <typename Solver>
void PropagateCovariance(const MotionProblem& problem, Hypothesis<Solver>* hypothesis);

// F with its derivatives along the principal axes of pose_cov; call PropagateCovariance first. nullopt if
// pose_cov is not finite and positive semi-definite.
template <typename Solver>
std::optional<UncertainFundamental> ComputeUncertainFundamental(const MotionProblem& problem,
                                                                const Hypothesis<Solver>& hypothesis);

}  // namespace rcme
