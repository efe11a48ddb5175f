#pragma once

#include "experiments/core/table/command_result.h"
#include "experiments/search/rate_crossing.h"

namespace rcme {

// One row per condition and estimator; JSON also has the events at every level examined.
CommandResult MakeCrossingsResult(const Study& study, const CrossingQuestion& question,
                                  const CrossingAnswer& answer);

}  // namespace rcme
