#pragma once

#include <CLI/CLI.hpp>

namespace rcme {

// Lines of `rcme --help` on the run of one study and its results.
inline constexpr const char* kStudySession =
    R"(  rcme run failure_vs_outliers --out run.sqlite                run one, or a study file of yours
  rcme summarize run.sqlite                                    rates with exact intervals
  rcme compare run.sqlite                                      each estimator against the first
  rcme summarize run.sqlite --format csv --out summary.csv     the same for programs and figures
  rcme plot failure_rate summary.csv --x outlier_ratio --out figure
  rcme report run.sqlite --out report.html                     everything on one page
  rcme failures run.sqlite                                     the trials that failed, as a list
)";

// The commands and help texts of a program: program.cc has all commands, demo_commands.cc those of
// scripts/demo.
struct CommandSet {
  const char* first_session;  // lines of `rcme --help`
  void (*add)(CLI::App&);     // adds the commands (commands.h)
  const char* footer;         // end of `rcme --help` and of the message on an unknown command
};

// Runs the command of a command line and returns the exit code (program.h).
int RunCommandLine(int argc, const char* const* argv, const CommandSet& commands,
                   const char* installed_share = "");

}  // namespace rcme
