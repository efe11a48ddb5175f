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
      {{"plane", "all points on one plane (Type B)", MakePlane}},
      {{"plane_and_parallax", "a plane, and some points off it", MakePlaneAndParallax}},
      {{"two_planes", "two planes that meet in a vertical edge: the corner of a room or of a house",
        MakeTwoPlanes}},
      {{"corridor", "walls, floor and ceiling, seen along a corridor", MakeCorridor}, "office", "forward"},
      {{"room", "walls, floor, ceiling and furniture, seen from the middle of a room", MakeRoom},
       "office",
       "hand_held"},
      {{"street", "road, facades on both sides, trees far away", MakeStreet}, "kitti", "vehicle"},
      {{"far_points", "a near uniform volume and points too far away for parallax", MakeFarPoints}},
      {{"lattice", "a facade that repeats itself: every cell of a lattice shows the same points",
        MakeLattice},
       "pinhole",
       "sideways"},
  };
  return registry;
}

}  // namespace rcme
