#pragma once

#include <string>

namespace rcme {

// What result files call this program: "rcme 0.1.0", or for one with estimators of its own "own_rcme (rcme
// 0.1.0)".
const std::string& ProgramName();

// To be called first, with the path the program was started by: argv[0].
void NameProgram(const std::string& path);

}  // namespace rcme
