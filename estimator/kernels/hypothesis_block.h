// Eight hypotheses side by side: from eight samples of eight matches to eight motions with their covariances.
#pragma once

#include <span>

#include "estimator/kernels/match_blocks.h"
#include "estimator/sample.h"

namespace rcme {

// Every array has the index [number][hypothesis]. All values are in whitened coordinates (match_blocks.h).
struct alignas(64) HypothesisBlock {
  using Row = double[kBlockSize];

  // The samples, number = the match within the sample. As many are used as the minimal solver takes.
  Row x1[kMaxSampleSize], y1[kMaxSampleSize], x2[kMaxSampleSize], y2[kMaxSampleSize];

  Row F[9];      // F_j row by row, for the E with singular values 1, 1, 0
  Row dF[5][9];  // its derivatives along the principal axes of Sigma_p: with L L' = Sigma_p, the k-th is
                 // sum_l L_lk dF/dp_l
  // T (JointSampleStatistic); infinite unless the misfit's covariance is positive definite
  Row sample_statistic;
  std::uint8_t is_model = 0;  // bit l: hypothesis l has a motion with a finite covariance
};

// The outputs to compute for a hypothesis.
enum class RequestedOutputs {
  kNone,                 // F alone
  kCovariance,           // also dF
  kCovarianceAndMisfit,  // also sample_statistic
};

// Copies the matches of a sample to the place `hypothesis` of the block.
void CopySample(const MatchBlocks& matches, const Sample& sample, int hypothesis, HypothesisBlock* block);

// Fills the block from eight samples of eight matches (eq::model_instantiate, eq::motion_estimate,
// eq::cov_p).
void InstantiateModels(const MatchBlocks& matches, std::span<const Sample, kBlockSize> samples,
                       RequestedOutputs outputs, HypothesisBlock* block);

}  // namespace rcme
