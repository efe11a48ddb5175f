#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/statistics/forecast_measures.h"

namespace rcme {

// For people: a line per estimator and group, and an explanation of the columns. `by`: the factor of the
// groups; empty: none.
std::string ForecastsAsTable(const std::vector<ForecastMeasures>& measures, const std::string& by = {});

// The table. The JSON document has every measure, the reliability curve with its band, the bins and the
// risk-coverage curve (`entries`); unknown and infinite numbers are null.
CommandResult MakeForecastResult(const std::string& study, const std::string& by,
                                 const std::vector<ForecastMeasures>& measures);

}  // namespace rcme
