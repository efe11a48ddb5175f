#include "tests/test_support/paths.h"

namespace rcme {

std::string SourceFolder() { return RCME_SOURCE_FOLDER; }
std::string ProgramPath() { return RCME_PROGRAM; }

}  // namespace rcme
