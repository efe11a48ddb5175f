#pragma once

#include <string>

namespace rcme {

// A name of a study or a scene as part of a file's name: what is no letter, digit, '_', '-' or '.' becomes
// '_', and a '.' in front gets one before it. Whatever a file calls its scene, the result lies in the folder
// that was asked for.
std::string MakeFileName(std::string name);

}  // namespace rcme
