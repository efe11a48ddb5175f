#pragma once

#include <string>

namespace rcme {

// Writes a text file whole or not at all: to a temporary neighbour first, then renamed over `path`. A device
// or pipe is written directly. Throws InputError that names the path and the reason.
void WriteFileWhole(const std::string& path, const std::string& text);

}  // namespace rcme
