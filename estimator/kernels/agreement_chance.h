// ChanceOfAgreement (motion_chance.h) for many matches at a time.
#pragma once

#include "estimator/geometry/pose.h"
#include "estimator/kernels/match_blocks.h"
#include "estimator/motion_chance.h"

namespace rcme {

// `box`: the bounding box of the second points.
double ChanceOfAgreement(const MatchBlocks& matches, const RelativePose& pose, const Box& box,
                         double threshold);

}  // namespace rcme
