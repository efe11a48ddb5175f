#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/search/rate_crossing.h"

namespace rcme {

// A row for each condition and estimator; in JSON also the events at every level that was asked.
CommandResult MakeCrossingsResult(const Study& study, const CrossingQuestion& question,
                                  const CrossingAnswer& answer);

}  // namespace rcme
