#pragma once

#include "experiments/core/table/command_result.h"
#include "experiments/real/paper_table/paper_table.h"

namespace rcme {

// For people: a table per estimator, then the rates printed in the paper. In files: a row per scene or
// group, estimator and quantity, followed by the printed rates with `source` paper; in JSON these are an
// array of their own.
CommandResult MakePaperResult(const PaperTable& table);

}  // namespace rcme
