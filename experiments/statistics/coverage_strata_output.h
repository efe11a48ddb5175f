#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/statistics/coverage_strata.h"

namespace rcme {

// A row per stratum: what `label_column` names ("estimator"), the visible quantity, its quarter, the coverage
// and the medians of the sharpness, the verdict, the range of the quantity's values, n.
Table MakeStrataTable(const std::string& label_column, const std::vector<std::string>& sharpness_names,
                      const std::vector<CoverageStratum>& strata);

// For people: a table for each label, below its name, so that a coverage and its sharpness stand side by
// side.
std::string StrataAsText(const std::vector<std::string>& sharpness_names,
                         const std::vector<CoverageStratum>& strata);

// What the columns are and how the intervals are made.
std::string DescribeStrata(StrataIntervals intervals);

CommandResult MakeStrataResult(const std::string& study, const CoverageStrata& strata);

}  // namespace rcme
