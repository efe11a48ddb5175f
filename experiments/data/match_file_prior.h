// The priors of the motion in the header of a match file (estimator/motion_prior.h).
#pragma once

#include <optional>
#include <string>

#include "estimator/motion_prior.h"
#include "experiments/data/match_header.h"

namespace rcme {

// Reads the measurements of sensors. Each measurement needs all of its keys or none.
std::optional<MotionPrior> ReadPrior(const MatchHeader& header);

// Formats a prior as header lines. A covariance is written as the standard deviations on its diagonal; the
// two standard deviations of gravity are written as their root mean square.
std::string FormatPrior(const MotionPrior& prior);

}  // namespace rcme
