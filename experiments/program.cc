#include "experiments/program.h"

#include <string>

#include "experiments/commands/commands.h"
#include "experiments/commands/run_command_line.h"

namespace rcme {
namespace {

// The lines of a first session before and after kStudySession.
constexpr const char* kBeforeAStudy =
    R"(  rcme ask                                                     which estimator, for your camera?
  rcme list studies                                            the installed studies
)";

constexpr const char* kAfterAStudy =
    R"(  rcme replay run.sqlite --condition 0 --trial 7               one trial again, in full
  rcme show run.sqlite --condition 0 --trial 7                 the same trial as a picture
  rcme tune tune_mu_lambda --out tuned.yaml                    thresholds with a guarantee
  rcme audit --out audit                                       every claim of the paper, checked
  rcme estimate matches.csv.gz                                 one real pair, or a folder of them
  rcme help estimate                                           help for a command
)";

void AddCommands(CLI::App& app) {
  app.group("Studies and their results");  // of the commands that follow
  AddAskCommand(app);
  AddLockCommand(app);
  AddRunCommand(app);
  AddSummarizeCommand(app);
  AddCompareCommand(app);
  AddGateCommand(app);
  AddIntegrityCommand(app);
  AddConformCommand(app);
  AddReliabilityCommand(app);
  AddMarginalsCommand(app);
  AddReportCommand(app);
  AddPlotCommand(app);
  AddFailuresCommand(app);
  AddReplayCommand(app);
  AddShowCommand(app);
  AddCheckCommand(app);
  AddMergeCommand(app);
  AddSolveCommand(app);
  AddSurfaceCommand(app);
  AddWorstCommand(app);
  app.group("Thresholds, efforts and answers made elsewhere");
  AddTuneCommand(app);
  AddTransferCommand(app);
  AddBudgetCommand(app);
  AddCheckEstimatorCommand(app);
  AddExportCommand(app);
  AddImportCommand(app);
  app.group("The paper's claims and their limits");
  AddAuditCommand(app);
  AddMapCommand(app);
  AddRareCommand(app);
  AddModelChoiceCommand(app);
  app.group("Real images");
  AddEstimateCommand(app);
  AddMatchCommand(app);
  AddPairsCommand(app);
  AddValidateCommand(app);
  AddCalibrateNoiseCommand(app);
  AddTwinCommand(app);
  AddCheckTruthCommand(app);
  AddPaperTableCommand(app);
  app.group("Help");
  AddListCommand(app);
  AddHelpCommand(app);
  AddCompletionCommand(app);
  AddManCommand(app);
}

}  // namespace

int RunProgram(int argc, const char* const* argv, const char* installed_share) {
  const std::string first_session = std::string(kBeforeAStudy) + kStudySession + kAfterAStudy;
  return RunCommandLine(argc, argv, {first_session.c_str(), AddCommands, ""}, installed_share);
}

}  // namespace rcme
