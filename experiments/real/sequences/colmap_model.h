// Reads a reconstruction of COLMAP: poses and cameras.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "estimator/geometry/lens.h"
#include "experiments/real/sequences/trajectory.h"

namespace rcme {

struct ColmapView {
  CameraPose pose;
  Lens lens;  // adjusted together with the poses; the database has the initial guess
};

// Returns the views by image name, from the files images and cameras (both .bin or both .txt) in the folder.
// Throws InputError that names the file if one is missing or truncated, or if a quaternion or camera is
// invalid or missing.
std::map<std::string, ColmapView> ReadColmapModel(const std::filesystem::path& folder);

}  // namespace rcme
