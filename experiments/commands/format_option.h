// The option --format of the commands that report a result.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "experiments/core/table/command_result.h"

namespace rcme {

// `format` has the default.
CLI::Option* AddFormatOption(CLI::App* command, std::string* format);

// In the format, to standard output or into the file `out`.
void PrintResult(const CommandResult& result, const std::string& format, const std::string& out = "");

// `stem`.txt, .csv and .json.
void WriteResultFiles(const CommandResult& result, const std::string& stem);

}  // namespace rcme
