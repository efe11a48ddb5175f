// The exact case for eight motions of five matches each: from their essential matrices to F and its
// derivatives along the principal axes of their covariance.
#pragma once

#include "estimator/kernels/hypothesis_block.h"

namespace rcme {

// Essential matrices for rays, of any scale and sign; index [entry, row by row][hypothesis].
struct alignas(64) EssentialBlock {
  HypothesisBlock::Row E[9];
};

// Fills F, is_model and, unless `outputs` is kNone, dF of the block (eq::motion_estimate, eq. 5, eq::cov_p).
// For dF, the block already holds the samples of five matches. There is no sample_statistic, because the
// motion fits its sample exactly.
void InstantiateExactModels(const RayScale& ray_scale, const EssentialBlock& essentials,
                            RequestedOutputs outputs, HypothesisBlock* block);

}  // namespace rcme
