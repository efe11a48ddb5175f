#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/real/truth_free/twin_report.h"

namespace rcme {

// Tables for people; a row per scene, twin and quantity; the same for programs, with the data blocks.
std::string TwinsAsText(const std::vector<TwinReport>& reports);
std::string TwinsAsJson(const std::vector<TwinReport>& reports);

CommandResult MakeTwinsResult(const std::vector<TwinReport>& reports);

}  // namespace rcme
