#pragma once

#include <CLI/CLI.hpp>

namespace rcme {

// What a program of commands consists of: all of them in program.cc, those of scripts/demo in demo_main.cc.
struct CommandSet {
  const char* first_session;  // lines of `rcme --help`
  void (*add)(CLI::App&);     // adds the commands (commands.h)
  const char* footer;         // ends `rcme --help`, and what is said of a word that is no command
};

// Runs the command of a command line and gives the exit code (program.h).
int RunCommandLine(int argc, const char* const* argv, const CommandSet& commands,
                   const char* installed_share = "");

}  // namespace rcme
