#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/search/rate_crossing.h"

namespace rcme {

// For people: a row for each condition and estimator.
std::string CrossingsAsTable(const Study& study, const CrossingQuestion& question,
                             const CrossingAnswer& answer);
// The same rows.
// The rows, and the events at every level that was asked.
std::string CrossingsAsJson(const Study& study, const CrossingQuestion& question,
                            const CrossingAnswer& answer);

CommandResult MakeCrossingsResult(const Study& study, const CrossingQuestion& question,
                                  const CrossingAnswer& answer);

}  // namespace rcme
