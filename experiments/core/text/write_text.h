// Takes a long text piece by piece, as FileInPieces does (core/files/file_output.h).
#pragma once

#include <functional>
#include <string>

namespace rcme {

using WriteText = std::function<void(const std::string& piece)>;

}  // namespace rcme
