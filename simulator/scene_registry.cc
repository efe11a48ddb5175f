#include "simulator/scene_registry.h"

#include "simulator/scenes/scenes.h"

namespace rcme {

const std::vector<SceneEntry>& SceneRegistry() {
  static const std::vector<SceneEntry> registry = {
      {{"uniform_volume", "points uniform over image 1 and in depth", MakeUniformVolume}},
      {{"clusters", "Gaussian clusters in space, the rest in a uniform volume", MakeClusters}},
      {{"image_clusters", "clusters in image 1, uniform in depth", MakeImageClusters}},
      {{"image_region", "a half, corner or band of image 1", MakeImageRegion}},
      {{"plane", "all points on one plane (Type B)", MakePlane}},
      {{"plane_and_parallax", "a plane, and some points off it", MakePlaneAndParallax}},
      {{"two_planes", "two planes with a vertical edge: a corner of a room or house", MakeTwoPlanes}},
      {{"corridor", "walls, floor and ceiling, seen along a corridor", MakeCorridor}, "office", "forward"},
      {{"room", "walls, floor, ceiling and furniture, seen from the middle", MakeRoom},
       "office",
       "hand_held"},
      {{"street", "road, facades on both sides, trees far away", MakeStreet}, "kitti", "vehicle"},
      {{"far_points", "a near volume and points too far away for parallax", MakeFarPoints}},
      {{"lattice", "a facade whose cells all show the same points", MakeLattice}, "pinhole", "sideways"},
  };
  return registry;
}

}  // namespace rcme
