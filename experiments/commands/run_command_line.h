#pragma once

#include <CLI/CLI.hpp>

namespace rcme {

// The commands and help texts of a program: program.cc has all commands, demo_commands.cc those of scripts/demo.
struct CommandSet {
  const char* first_session;  // lines of `rcme --help`
  void (*add)(CLI::App&);     // adds the commands (commands.h)
  const char* footer;         // end of `rcme --help` and of the message on an unknown command
};

// Runs the command of a command line and returns the exit code (program.h).
int RunCommandLine(int argc, const char* const* argv, const CommandSet& commands,
                   const char* installed_share = "");

}  // namespace rcme
