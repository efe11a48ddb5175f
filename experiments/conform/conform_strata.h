// Coverage and size of the stated and the conformed regions by strata that are visible at run time
// (statistics/coverage_strata.h).
#pragma once

#include <vector>

#include "experiments/conform/conform_report.h"
#include "experiments/statistics/coverage_strata.h"

namespace rcme {

// Strata of: matches, agreeing matches, parallax over its noise, planarity, stated standard deviations (deg)
// and stated probability of failure. These are in natural units, unlike the logarithms of visible_features.h.
// Sharpness is the size of the region (deg). The label is the region's name.
std::vector<CoverageStratum> MeasureConformStrata(const ConformReport& report);

}  // namespace rcme
