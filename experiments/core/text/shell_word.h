#pragma once

#include <string>

namespace rcme {

// A word of a command that a user copies into a shell: in single quotes if the shell would read it as
// anything but itself.
std::string QuoteForShell(const std::string& word);

}  // namespace rcme
