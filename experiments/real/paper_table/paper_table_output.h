#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/real/paper_table/paper_table.h"

namespace rcme {

// For people a table per estimator, then what the paper prints. In files a row per scene or group, estimator
// and quantity; the printed rates follow with `source` paper, in JSON as an array of their own.
CommandResult MakePaperResult(const PaperTable& table);

}  // namespace rcme
