#pragma once

#include "simulator/registry.h"
#include "simulator/scene_model.h"

namespace rcme {

// A scene comes with the cameras and the motion that it is usually seen with; a study may choose others.
struct SceneEntry : RegistryEntry<SceneModel> {
  std::string cameras = "pinhole";
  std::string motion = "general";
};
const std::vector<SceneEntry>& SceneRegistry();

}  // namespace rcme
