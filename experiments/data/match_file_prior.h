// What the header of a match file says of the motion's priors (estimator/motion_prior.h).
#pragma once

#include <optional>
#include <string>

#include "estimator/motion_prior.h"
#include "experiments/data/match_header.h"

namespace rcme {

// What sensors say; of each measurement every key must be there, or none.
std::optional<MotionPrior> ReadPrior(const MatchHeader& header);

// The header lines of a prior; a covariance by the standard deviations on its diagonal, of gravity the noise
// of both as that of each.
std::string FormatPrior(const MotionPrior& prior);

}  // namespace rcme
