// A rate of a tuning in tables and figures' data.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "experiments/core/table/table.h"
#include "stats/risk_control.h"

namespace rcme {

// NaN where n is 0.
double ComputeRate(const ErrorCount& count);

// With the exact 95 % interval.
Estimate EstimateRate(const ErrorCount& count);

// "1.23 % [1.01, 1.50]"; "-" where n is 0.
std::string RateForTable(const ErrorCount& count);

// {"value", "lower", "upper", "n"}: the rate with its exact 95 % interval; value null where n is 0.
nlohmann::ordered_json RateAsJson(const ErrorCount& count);

}  // namespace rcme
