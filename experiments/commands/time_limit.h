// The option --max-time, for commands whose work can be resumed.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace rcme {

// It ends between two `pieces` ("trials"). An empty text is no limit.
CLI::Option* AddTimeLimit(CLI::App* command, const std::string& pieces, std::string* max_time);

// The time begins; while a StopOnSignals lives (core/work/stop_request.h).
void StartTimeLimit(const std::string& max_time);

}  // namespace rcme
