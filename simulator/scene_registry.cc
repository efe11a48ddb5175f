#include "simulator/scene_registry.h"

#include "simulator/scenes/scenes.h"

namespace rcme {

const std::vector<SceneEntry>& SceneRegistry() {
  static const std::vector<SceneEntry> registry = {
      {{"uniform_volume", "points uniform over the first image, uniform in a depth range",
        MakeUniformVolume}},
      {{"clusters", "Gaussian clusters in space, the rest of the points in a uniform volume", MakeClusters}},
      {{"image_clusters", "matches in clusters of the first image, as many as you like; depths stay uniform",
        MakeImageClusters}},
      {{"image_region", "all matches in the left half, a corner or a band of the first image",
        MakeImageRegion}},
      {{"far_points", "a near uniform volume and points too far away for parallax", MakeFarPoints}},
  };
  return registry;
}

}  // namespace rcme
