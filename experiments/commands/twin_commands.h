// Commands that compare real pairs with simulation, with their given truth and with the paper (see
// commands.h).
#pragma once

#include <CLI/CLI.hpp>

namespace rcme {

void AddCheckTruthCommand(CLI::App& app);
void AddPaperTableCommand(CLI::App& app);
void AddTwinCommand(CLI::App& app);

}  // namespace rcme
