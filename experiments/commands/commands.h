// The commands of the program `rcme`. Each adds its subcommand to the parser; its callback does the work and
// throws InputError for bad input.
#pragma once

#include <CLI/CLI.hpp>

namespace rcme {

// Thrown by a command that has printed its messages and ends the program with its own exit code.
struct EndWith {
  int exit_code;
};

void AddAskCommand(CLI::App& app);
void AddLockCommand(CLI::App& app);
void AddRunCommand(CLI::App& app);
void AddAuditCommand(CLI::App& app);
void AddSummarizeCommand(CLI::App& app);
void AddCompareCommand(CLI::App& app);
void AddConformCommand(CLI::App& app);
void AddGateCommand(CLI::App& app);
void AddIntegrityCommand(CLI::App& app);
void AddFailuresCommand(CLI::App& app);
void AddReliabilityCommand(CLI::App& app);
void AddMarginalsCommand(CLI::App& app);
void AddReportCommand(CLI::App& app);
void AddCheckCommand(CLI::App& app);
void AddMergeCommand(CLI::App& app);
void AddPlotCommand(CLI::App& app);
void AddExportCommand(CLI::App& app);
void AddImportCommand(CLI::App& app);
void AddReplayCommand(CLI::App& app);
void AddShowCommand(CLI::App& app);
void AddEstimateCommand(CLI::App& app);
void AddMatchCommand(CLI::App& app);
void AddPairsCommand(CLI::App& app);
void AddTuneCommand(CLI::App& app);
void AddBudgetCommand(CLI::App& app);
void AddTransferCommand(CLI::App& app);
void AddMapCommand(CLI::App& app);
void AddRareCommand(CLI::App& app);
void AddSolveCommand(CLI::App& app);
void AddSurfaceCommand(CLI::App& app);
void AddWorstCommand(CLI::App& app);
void AddModelChoiceCommand(CLI::App& app);
void AddValidateCommand(CLI::App& app);
void AddCalibrateNoiseCommand(CLI::App& app);
void AddTwinCommand(CLI::App& app);
void AddCheckTruthCommand(CLI::App& app);
void AddPaperTableCommand(CLI::App& app);
void AddCheckEstimatorCommand(CLI::App& app);
void AddListCommand(CLI::App& app);
// These three describe the commands added before them.
void AddHelpCommand(CLI::App& app);
void AddCompletionCommand(CLI::App& app);
void AddManCommand(CLI::App& app);

}  // namespace rcme
