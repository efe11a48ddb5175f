// Eight motions of five matches each, the exact case, side by side: from their essential matrices to F and
// its derivatives along the principal axes of their covariance.
#pragma once

#include "estimator/kernels/hypothesis_block.h"

namespace rcme {

// Essential matrices in rays, of any scale and sign: number = the entry, row by row.
struct alignas(64) EssentialBlock {
  HypothesisBlock::Row E[9];
};

// Fills F, dF unless `outputs` is kNone, and is_model of the block, whose samples of five matches are in
// place (eq::motion_estimate, eq. 5, eq::cov_p). There is no sample_statistic: the motion fits its sample.
void InstantiateExactModels(const RayScale& ray_scale, const EssentialBlock& essentials,
                            RequestedOutputs outputs, HypothesisBlock* block);

}  // namespace rcme
