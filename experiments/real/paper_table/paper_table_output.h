#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/real/paper_table/paper_table.h"

namespace rcme {

// A table per estimator, then what the paper prints.
std::string PaperTableAsText(const PaperTable& table);
// A row per scene or group, estimator and quantity; the printed rates follow with `source` paper.
Table MakePaperFileTable(const PaperTable& table);
// The same rows as objects.
std::string PaperTableAsJson(const PaperTable& table);

CommandResult MakePaperResult(const PaperTable& table);

}  // namespace rcme
