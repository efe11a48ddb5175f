#include <fmt/format.h>

#include <algorithm>

#include "parameters/input_error.h"
#include "simulator/scenes/scenes.h"
#include "simulator/scenes/surfaces.h"

namespace rcme {
namespace {

constexpr int kMaxTriesPerBox = 1000;
constexpr double kLeastBoxSide = 0.25;  // of max_box_size_m

// The faces of a box between two corners; top and bottom are optional (y points down: low is the top).
void AddFaces(const Eigen::Vector3d& low, const Eigen::Vector3d& high, bool has_top, bool has_bottom,
              std::vector<Rectangle>* faces) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool is_low : {true, false}) {
      if (axis == 1 && !(is_low ? has_top : has_bottom)) continue;
      Rectangle face{axis, low, high};
      (is_low ? face.high : face.low)(axis) = (is_low ? low : high)(axis);
      faces->push_back(face);
    }
  }
}

class RoomWorld : public World {
 public:
  RoomWorld(const UprightCamera& camera1, std::vector<Rectangle> faces)
      : camera_(camera1), faces_(std::move(faces)) {}

  void DrawCandidates(size_t, size_t, RandomStream& rng, PointBlock* block) const override {
    camera_.DrawPoints(faces_, rng, block);
  }

 private:
  UprightCamera camera_;
  std::vector<Rectangle> faces_;
};

// A room with boxes on its floor, parallel to its walls; boxes may intersect. Points are uniform over image
// 1, each the first surface on its ray. Points that boxes hide from camera 2 alone are kept: between near
// views they are few, and their matches are true.
//
// Building frame: the origin is on the floor in the middle of the room, z along room_length_m.
class Room : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {
        Parameter::Real("room_width_m", &width_m_, {1e-3, 1e6}, "m", "one side of the room"),
        Parameter::Real("room_length_m", &length_m_, {1e-3, 1e6}, "m", "the other side of the room"),
        Parameter::Real("room_height_m", &height_m_, {1e-3, 1e6}, "m", "floor to ceiling"),
        Parameter::Real("camera_height_m", &camera_height_m_, {1e-3, 1e6}, "m",
                        "height above the floor, anywhere in the room's middle half, level in any direction"),
        Parameter::Integer("num_boxes", &num_boxes_, {0, 1000}, "boxes anywhere on the floor"),
        Parameter::Real("max_box_size_m", &max_box_size_m_, {1e-3, 1e6}, "m",
                        "greatest side of a box; sides are uniform from a quarter of it"),
        Parameter::Real("free_radius_m", &free_radius_m_, {0.0, 1e6}, "m",
                        "least distance of boxes from camera 1 on the floor")};
  }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream& rng) const override {
    Check();
    const double x_m = rng.Uniform(-0.25 * width_m_, 0.25 * width_m_);
    const double z_m = rng.Uniform(-0.25 * length_m_, 0.25 * length_m_);
    const UprightCamera camera1(view.camera1, {x_m, -camera_height_m_, z_m}, rng.Uniform());
    std::vector<Rectangle> faces;
    AddFaces({-0.5 * width_m_, -height_m_, -0.5 * length_m_}, {0.5 * width_m_, 0.0, 0.5 * length_m_}, true,
             true, &faces);
    for (int k = 0; k < num_boxes_; ++k) AddBox({x_m, z_m}, rng, &faces);
    return std::make_unique<RoomWorld>(camera1, camera1.InView(std::move(faces)));
  }

 private:
  void Check() const {
    if (camera_height_m_ >= height_m_) {
      throw InputError(fmt::format("camera_height_m: {} is not allowed; give less than room_height_m = {}",
                                   camera_height_m_, height_m_));
    }
    if (num_boxes_ > 0 && max_box_size_m_ > std::min(width_m_, length_m_)) {
      throw InputError(
          fmt::format("max_box_size_m: {} is not allowed; give at most the smaller of room_width_m = {} and "
                      "room_length_m = {}",
                      max_box_size_m_, width_m_, length_m_));
    }
  }

  // A box wholly inside the room that keeps free_radius_m from the camera (`camera_xz`, on the floor).
  void AddBox(const Eigen::Vector2d& camera_xz, RandomStream& rng, std::vector<Rectangle>* faces) const {
    for (int tries = 0; tries < kMaxTriesPerBox; ++tries) {
      const double size_x = DrawSide(rng), size_y = std::min(DrawSide(rng), height_m_),
                   size_z = DrawSide(rng);
      const double x_m = rng.Uniform(-0.5 * width_m_, 0.5 * width_m_ - size_x);
      const double z_m = rng.Uniform(-0.5 * length_m_, 0.5 * length_m_ - size_z);
      const Eigen::Vector2d low(x_m, z_m), high(x_m + size_x, z_m + size_z);
      const Eigen::Vector2d nearest = camera_xz.cwiseMax(low).cwiseMin(high);
      if ((nearest - camera_xz).norm() < free_radius_m_) continue;
      return AddFaces({low.x(), -size_y, low.y()}, {high.x(), 0.0, high.y()}, true, false, faces);
    }
    throw InputError(
        fmt::format("num_boxes: no place for a box in {} tries; with free_radius_m = {} give a smaller "
                    "max_box_size_m or a "
                    "larger room_width_m and room_length_m",
                    kMaxTriesPerBox, free_radius_m_));
  }
  double DrawSide(RandomStream& rng) const {
    return rng.Uniform(kLeastBoxSide * max_box_size_m_, max_box_size_m_);
  }

  double width_m_ = 6.0, length_m_ = 8.0, height_m_ = 2.8, camera_height_m_ = 1.2;
  int num_boxes_ = 8;
  double max_box_size_m_ = 1.2, free_radius_m_ = 1.0;
};

}  // namespace

std::unique_ptr<SceneModel> MakeRoom() { return std::make_unique<Room>(); }

}  // namespace rcme
