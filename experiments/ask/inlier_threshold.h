// Which matches an estimator takes for inliers, in words and with the unit of the number.
#pragma once

#include <string>

#include "parameters/settings.h"

namespace rcme {

// Of the estimator `name` of the program with these options, for noise of sigma_px:
// "1.37 px of Sampson distance (1.96 sigma: ...)", "none in px: ...". Empty: not known of this estimator.
std::string DescribeInlierThreshold(const std::string& name, const Settings& options, double sigma_px);

}  // namespace rcme
