#pragma once

namespace rcme {

// The program of scripts/demo on a command line: `rcme` with the commands of a first study alone.
// The exit codes are those of RunProgram (program.h).
int RunDemoProgram(int argc, const char* const* argv);

}  // namespace rcme
