#pragma once

#include "simulator/registry.h"
#include "simulator/scene_model.h"

namespace rcme {

// A scene with its default cameras and motion; a study may choose others.
struct SceneEntry : RegistryEntry<SceneModel> {
  std::string cameras = "pinhole";
  std::string motion = "general";
};
const std::vector<SceneEntry>& SceneRegistry();

}  // namespace rcme
