#include "simulator/scene_registry.h"

#include "simulator/scenes/scenes.h"

namespace rcme {

const std::vector<SceneEntry>& SceneRegistry() {
  static const std::vector<SceneEntry> registry = {
      {{"uniform_volume", "points uniform over the first image, uniform in a depth range",
        MakeUniformVolume}},
  };
  return registry;
}

}  // namespace rcme
