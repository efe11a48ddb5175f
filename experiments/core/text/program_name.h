#pragma once

#include <string>

namespace rcme {

// The name of this program in result files: "rcme 0.1.0"; a program with its own estimators is "own_rcme
// (rcme 0.1.0)".
const std::string& ProgramName();

// The word that starts this program in a command for people: "rcme", "own_rcme".
std::string CommandName();

// Sets the name from argv[0]. Call this first.
void NameProgram(const std::string& path);

// The program and machine code that computed trials: the last bits of the results may depend on them.
struct TrialOrigin {
  std::string program;          // ProgramName()
  std::string instruction_set;  // estimator/instruction_set.h

  bool operator==(const TrialOrigin&) const = default;
};

}  // namespace rcme
