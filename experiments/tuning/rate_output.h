// Formats a rate of a tuning for tables and the data of figures.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "experiments/core/table/table.h"
#include "stats/risk_control.h"

namespace rcme {

// NaN if n is 0.
double ComputeRate(const ErrorCount& count);

// The rate with its exact 95 % interval.
Estimate EstimateRate(const ErrorCount& count);

// "1.23 % [1.01, 1.50]"; "-" if n is 0.
std::string RateForTable(const ErrorCount& count);

// {"value", "lower", "upper", "n"}: the rate with its exact 95 % interval; value is null if n is 0.
nlohmann::ordered_json RateAsJson(const ErrorCount& count);

}  // namespace rcme
