#pragma once

#include <string>

namespace rcme {

// The root of the source tree, and the built program.
std::string SourceFolder();
std::string ProgramPath();

}  // namespace rcme
