#pragma once

#include <string>

namespace rcme {

// What result files call this program: "rcme 0.1.0", or for one with estimators of its own "own_rcme (rcme
// 0.1.0)".
const std::string& ProgramName();

// To be called first, with the path the program was started by: argv[0].
void NameProgram(const std::string& path);

// Who computes trials: last bits may depend on it.
struct TrialOrigin {
  std::string program;          // ProgramName()
  std::string instruction_set;  // estimator/instruction_set.h

  bool operator==(const TrialOrigin&) const = default;
};

}  // namespace rcme
