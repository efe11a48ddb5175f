// Surfaces inside a building or a street: rectangles parallel to the axes, hit by viewing rays.
//
// Building frame (m): y down along gravity, x and z level along the walls. Each scene defines its origin.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "simulator/scene_camera.h"
#include "simulator/scene_model.h"
#include "simulator/scenes/view_volume.h"
#include "stats/random.h"

namespace rcme {

// All points with low <= point <= high in the building frame; low and high are equal along the normal's axis.
struct Rectangle {
  int normal_axis;  // 0, 1, 2: x, y, z
  Eigen::Vector3d low, high;
};

// An upright camera in the building, turned to the right by `turn` full turns; at 0 its axes are those of the
// building.
class UprightCamera {
 public:
  UprightCamera(const SceneCamera& camera, const Eigen::Vector3d& centre_in_building, double turn);

  // A viewing ray, given in camera axes, in the axes of the building.
  Eigen::Vector3d InBuildingAxes(const Eigen::Vector3d& ray) const;
  // Those rectangles that the image may show; it shows nothing of the others. With a lens: all.
  std::vector<Rectangle> InView(std::vector<Rectangle> rectangles) const;
  // The depth (third coordinate in the camera, m) of the first rectangle on each ray; infinite if there is
  // none.
  RayBlock::Numbers FirstDepths(const RayBlock& rays, std::span<const Rectangle> rectangles) const;
  // The first points (camera frame) on the rays of pixels uniform over the image; UnseenPoint() for a ray
  // that hits no rectangle.
  void DrawPoints(std::span<const Rectangle> rectangles, RandomStream& rng, PointBlock* block) const;

 private:
  SceneCamera camera_;
  Eigen::Vector3d centre_;
  double cos_turn_, sin_turn_;
};

// An angle uniform in [-max_deg, max_deg], in turns.
double DrawTurn(double max_deg, RandomStream& rng);

}  // namespace rcme
