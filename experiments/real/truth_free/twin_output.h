#pragma once

#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/real/truth_free/twin_report.h"

namespace rcme {

// Tables for people; for programs one row for each scene, twin and quantity. JSON also has the data blocks.
CommandResult MakeTwinsResult(const std::vector<TwinReport>& reports);

}  // namespace rcme
