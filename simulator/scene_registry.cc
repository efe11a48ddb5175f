#include "simulator/scene_registry.h"

#include "simulator/scenes/uniform_volume.h"

namespace rcme {

const std::vector<SceneEntry>& SceneRegistry() {
  static const std::vector<SceneEntry> registry = {
      {"uniform_volume", "points uniform over the first image, uniform in a depth range; general motion",
       [] { return std::make_unique<UniformVolume>(); }},
  };
  return registry;
}

const SceneEntry* FindScene(const std::string& name) {
  for (const SceneEntry& entry : SceneRegistry()) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

}  // namespace rcme
