// A reconstruction of COLMAP: where the cameras are, and what they are like.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "estimator/geometry/lens.h"
#include "experiments/real/sequences/trajectory.h"

namespace rcme {

struct ColmapView {
  CameraPose pose;
  Lens lens;  // as adjusted with the poses: the database keeps what was guessed before
};

// By image name, from images and cameras, both .bin or both .txt, of the folder. Throws InputError that names
// the file: one is not there, it ends early, a quaternion that is none, a camera that is none or not there.
std::map<std::string, ColmapView> ReadColmapModel(const std::filesystem::path& folder);

}  // namespace rcme
