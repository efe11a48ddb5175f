#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/statistics/coverage_strata.h"

namespace rcme {

// Makes a table with a row per stratum: the label in a column named `label_column` (such as "estimator"),
// the visible quantity, its quarter, the coverage, the medians of the sharpness, the verdict, the range of
// the quantity, n.
Table MakeStrataTable(const std::string& label_column, const std::vector<std::string>& sharpness_names,
                      const std::vector<CoverageStratum>& strata);

// For people: a table for each label, under the label.
std::string StrataAsText(const std::vector<std::string>& sharpness_names,
                         const std::vector<CoverageStratum>& strata);

// Explains the columns and the intervals.
std::string DescribeStrata(StrataIntervals intervals);

CommandResult MakeStrataResult(const std::string& study, const CoverageStrata& strata);

}  // namespace rcme
