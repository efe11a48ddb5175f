#pragma once

#include <string>

namespace rcme {

// The first line in which two identities of a study differ, as "'a' there, 'b' here".
std::string FirstDifference(const std::string& there, const std::string& here);

}  // namespace rcme
