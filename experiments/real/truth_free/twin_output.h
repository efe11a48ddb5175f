#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/real/truth_free/twin_report.h"

namespace rcme {

// Tables for people; a row per scene, twin and quantity for programs; in JSON also the data blocks.
CommandResult MakeTwinsResult(const std::vector<TwinReport>& reports);

}  // namespace rcme
