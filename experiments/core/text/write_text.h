// A function that takes a long text piece by piece, such as FileInPieces::Write (core/files/file_output.h).
#pragma once

#include <functional>
#include <string>

namespace rcme {

using WriteText = std::function<void(const std::string& piece)>;

}  // namespace rcme
