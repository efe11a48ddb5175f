#include "experiments/program.h"

#include "experiments/commands/commands.h"
#include "experiments/commands/run_command_line.h"
#include "experiments/commands/twin_commands.h"

namespace rcme {
namespace {

constexpr const char* kFirstSession =
    R"(  rcme ask                                                     which estimator, for your camera?
  rcme list studies                                            the installed studies
  rcme run failure_vs_outliers --out run.sqlite                run one, or a study file of yours
  rcme summarize run.sqlite                                    rates with exact intervals
  rcme compare run.sqlite                                      each estimator against the first
  rcme summarize run.sqlite --format csv --out summary.csv     the same for programs and figures
  rcme plot failure_rate summary.csv --x outlier_ratio --out figure
  rcme report run.sqlite --out report.html                     everything on one page
  rcme failures run.sqlite                                     the trials that failed, as a list
  rcme replay run.sqlite --condition 0 --trial 7               one trial again, in full
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
  return RunCommandLine(argc, argv, {kFirstSession, AddCommands, ""}, installed_share);
}

}  // namespace rcme
