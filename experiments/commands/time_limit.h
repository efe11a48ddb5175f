// The option --max-time, for commands whose work can be resumed.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace rcme {

// Adds --max-time. `pieces` names the items between which the command can stop: "trials". An empty time is no
// limit.
CLI::Option* AddTimeLimit(CLI::App* command, const std::string& pieces, std::string* max_time);

// Starts the clock. Call it while a StopOnSignals exists (core/work/stop_request.h).
void StartTimeLimit(const std::string& max_time);

}  // namespace rcme
