#include "experiments/commands/demo_commands.h"

#include "experiments/commands/commands.h"
#include "experiments/commands/run_command_line.h"

namespace rcme {
namespace {

constexpr CommandSet kDemoCommands = {
    R"(  rcme run failure_vs_outliers --out run.sqlite                run one, or a study file of yours
  rcme summarize run.sqlite                                    rates with exact intervals
  rcme compare run.sqlite                                      each estimator against the first
  rcme summarize run.sqlite --format csv --out summary.csv     the same for programs and figures
  rcme plot failure_rate summary.csv --x outlier_ratio --out figure
  rcme report run.sqlite --out report.html                     everything on one page
  rcme failures run.sqlite                                     the trials that failed, as a list
)",
    [](CLI::App& app) {
      app.group("Studies and their results");  // of the commands that follow
      AddRunCommand(app);
      AddSummarizeCommand(app);
      AddCompareCommand(app);
      AddReportCommand(app);
      AddPlotCommand(app);
      AddFailuresCommand(app);
      AddCheckCommand(app);
      app.group("Help");
      AddHelpCommand(app);
    },
    "scripts/demo built only these commands; `scripts/build release program` builds rcme with all of them."};

}  // namespace

int RunDemoProgram(int argc, const char* const* argv) { return RunCommandLine(argc, argv, kDemoCommands); }

}  // namespace rcme
