// What a camera sees inside a building or a street: rectangles parallel to the axes, met by viewing rays.
//
// Building frame (m): y down along gravity, x and z level along the walls; each scene says where its origin
// is.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "simulator/scene_camera.h"
#include "stats/random.h"

namespace rcme {

// All points with low <= point <= high in the building frame; low and high agree in the axis of the normal.
struct Rectangle {
  int normal_axis;  // 0, 1, 2: x, y, z
  Eigen::Vector3d low, high;
};

// A camera that stands upright in the building, turned to the right by a part of a turn: at 0 its axes are
// those of the building.
class UprightCamera {
 public:
  UprightCamera(const SceneCamera& camera, const Eigen::Vector3d& centre_in_building, double turn);

  // A viewing ray, given in camera axes, in the axes of the building.
  Eigen::Vector3d InBuildingAxes(const Eigen::Vector3d& ray) const;
  // The depth (third coordinate in the camera, m) of the first rectangle on the ray; infinite if the ray
  // meets no rectangle.
  double FirstDepth(const Eigen::Vector3d& ray, std::span<const Rectangle> rectangles) const;
  // The point (camera frame) of the first rectangle on the ray of a pixel uniform over the image; where it
  // meets no rectangle, UnseenPoint().
  Eigen::Vector3d DrawPoint(std::span<const Rectangle> rectangles, RandomStream& rng) const;

 private:
  SceneCamera camera_;
  Eigen::Vector3d centre_;
  double cos_turn_, sin_turn_;
};

// An angle uniform in [-max_deg, max_deg], in turns.
double DrawTurn(double max_deg, RandomStream& rng);

}  // namespace rcme
