#pragma once

#include <string>

namespace rcme {

// Makes a file name from the name of a study or a scene. Characters other than letters, digits, '_', '-' and
// '.' become '_'; an empty name or one that begins with '.' gets a '_' in front. The result never leaves the
// folder into which it is written, whatever name a file gives its scene.
std::string MakeFileName(std::string name);

}  // namespace rcme
