// The images of a COLMAP reconstruction: where the cameras are.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "experiments/sequences/trajectory.h"

namespace rcme {

// By image name, from images.bin or images.txt of the folder. Throws InputError that names the file: neither
// is there, it ends early, a quaternion that is none.
std::map<std::string, CameraPose> ReadColmapPoses(const std::filesystem::path& folder);

}  // namespace rcme
