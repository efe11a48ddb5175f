// The scenes that scene_registry lists, one file each.
#pragma once

#include <memory>

#include "simulator/scene_model.h"

namespace rcme {

std::unique_ptr<SceneModel> MakeUniformVolume();
// Gaussian clusters in space before a uniform volume.
std::unique_ptr<SceneModel> MakeClusters();
// A cluster process on image 1, at depths of a uniform volume.
std::unique_ptr<SceneModel> MakeImageClusters();
// A uniform volume behind one rectangle of image 1.
std::unique_ptr<SceneModel> MakeImageRegion();
// One plane (Type B).
std::unique_ptr<SceneModel> MakePlane();
// The same with some points off the plane.
std::unique_ptr<SceneModel> MakePlaneAndParallax();
// Two planes that meet in a vertical edge.
std::unique_ptr<SceneModel> MakeTwoPlanes();
// A uniform volume and points without parallax behind it.
std::unique_ptr<SceneModel> MakeFarPoints();

}  // namespace rcme
