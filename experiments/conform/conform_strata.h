// Coverage and size of the stated and the conformed regions by strata that are visible at run time
// (statistics/coverage_strata.h).
#pragma once

#include <vector>

#include "experiments/conform/conform_report.h"
#include "experiments/statistics/coverage_strata.h"

namespace rcme {

// By matches, agreeing matches, parallax over its noise, planarity, stated standard deviations and stated
// probability, in their own units (visible_features.h has logarithms); sharpness: the size of the region
// (deg). The label is the region's name.
std::vector<CoverageStratum> MeasureConformStrata(const ConformReport& report);

}  // namespace rcme
