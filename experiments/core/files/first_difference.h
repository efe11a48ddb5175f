#pragma once

#include <string>

namespace rcme {

// Returns the first line in which two descriptions of a study differ, as "'a' there, 'b' here".
std::string FirstDifference(const std::string& there, const std::string& here);

}  // namespace rcme
