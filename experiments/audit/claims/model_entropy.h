// The entropy of one model's inlier set, for the claims about entropy, Z-test and mu.
#pragma once

#include "estimator/reference_search.h"
#include "estimator/solvers/eight_point.h"
#include "experiments/audit/claims/case.h"

namespace rcme {

// The eight-point model of a sample with its covariances; nullopt if it is degenerate.
std::optional<UncertainFundamental> ComputeSampleModel(const MotionProblem& problem, const Sample& sample);

// A sample of eight matches as RANSAC draws it, given that all of them are true (kGood) or that not all are.
enum class SampleKind { kGood, kContaminated };
Sample DrawSampleByKind(SampleKind kind, Case& made);

// n_j, psi_j and s_j of the model of a sample, scored on all matches; without inliers if it is degenerate.
template <typename PointTest>
InlierScore ScoreSample(const MotionProblem& problem, const Sample& sample) {
  const std::optional<UncertainFundamental> model = ComputeSampleModel(problem, sample);
  if (!model) return {};
  const Thresholds thresholds = Thresholds::For(problem, RansacOptions(), PointTest::kDegreesOfFreedom);
  return ScoreInliers(problem, PointTest(*model, problem.sigma_px), thresholds);
}

// psi_j; infinite without inliers.
double MeanEntropyOrInfinity(const InlierScore& score);

}  // namespace rcme
