// The commands that compare real pairs with simulation and with the paper; see commands.h.
#pragma once

#include <CLI/CLI.hpp>

namespace rcme {

void AddPaperTableCommand(CLI::App& app);
void AddTwinCommand(CLI::App& app);

}  // namespace rcme
