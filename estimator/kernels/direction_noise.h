// SumDirectionNoise (observability.h) for many matches at a time.
#pragma once

#include "estimator/geometry/pose.h"
#include "estimator/kernels/match_blocks.h"

namespace rcme {

// The sum over the matches of the mask.
Eigen::Matrix2d SumDirectionNoise(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose,
                                  const Eigen::Matrix2d& direction_cov);

}  // namespace rcme
