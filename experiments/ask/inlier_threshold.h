// Describes in words, with units, which matches an estimator takes for inliers.
#pragma once

#include <string>

#include "parameters/settings.h"

namespace rcme {

// Describes the threshold of the built-in estimator `name` with these options, for noise of sigma_px:
// "1.37 px of Sampson distance (1.96 sigma: ...)", "none in px: ...". Empty if it is unknown.
std::string DescribeInlierThreshold(const std::string& name, const Settings& options, double sigma_px);

}  // namespace rcme
