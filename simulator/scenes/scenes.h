// The scenes that scene_registry lists, one file each.
#pragma once

#include <memory>

#include "simulator/scene_model.h"

namespace rcme {

std::unique_ptr<SceneModel> MakeUniformVolume();
// Gaussian clusters in space, and a uniform volume as background.
std::unique_ptr<SceneModel> MakeClusters();
// A cluster process on image 1, with the depths of a uniform volume.
std::unique_ptr<SceneModel> MakeImageClusters();
// A uniform volume behind one rectangle of image 1.
std::unique_ptr<SceneModel> MakeImageRegion();
// One plane (Type B).
std::unique_ptr<SceneModel> MakePlane();
// A plane and some points off it.
std::unique_ptr<SceneModel> MakePlaneAndParallax();
// Two planes that meet in a vertical edge.
std::unique_ptr<SceneModel> MakeTwoPlanes();
// Two walls, floor and ceiling, seen along the corridor.
std::unique_ptr<SceneModel> MakeCorridor();
// A room with boxes on its floor, seen from its middle.
std::unique_ptr<SceneModel> MakeRoom();
// Road, facades on both sides, and points beyond the street's end.
std::unique_ptr<SceneModel> MakeStreet();
// A uniform volume and points without parallax behind it.
std::unique_ptr<SceneModel> MakeFarPoints();
// A facade that repeats itself.
std::unique_ptr<SceneModel> MakeLattice();

}  // namespace rcme
