#include "experiments/commands/demo_commands.h"

#include "experiments/commands/commands.h"
#include "experiments/commands/run_command_line.h"

namespace rcme {
namespace {

constexpr CommandSet kDemoCommands = {
    kStudySession,
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
