// The option --format of the commands that report a result.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "experiments/core/table/command_result.h"

namespace rcme {

// Adds --format; the initial value of `format` is the default.
CLI::Option* AddFormatOption(CLI::App* command, std::string* format);

// Prints the result in the format to standard output, or writes it to the file `out` if that is not empty.
void PrintResult(const CommandResult& result, const std::string& format, const std::string& out = "");

// Writes `stem`.txt, .csv and .json.
void WriteResultFiles(const CommandResult& result, const std::string& stem);

}  // namespace rcme
