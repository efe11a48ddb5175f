#include <fmt/format.h>

#include "parameters/input_error.h"
#include "simulator/scenes/scenes.h"
#include "simulator/scenes/shares.h"
#include "simulator/scenes/surfaces.h"

namespace rcme {
namespace {

// Part 0: both walls, 1: floor, 2: ceiling. A corridor is convex, so there is no occlusion.
class CorridorWorld : public World {
 public:
  CorridorWorld(const UprightCamera& camera1, std::vector<std::vector<Rectangle>> parts,
                std::vector<double> shares)
      : camera_(camera1), parts_(std::move(parts)), shares_(std::move(shares)) {}

  std::vector<double> PartShares() const override { return shares_; }

  void DrawCandidates(size_t part, size_t, RandomStream& rng, PointBlock* block) const override {
    camera_.DrawPoints(parts_[part], rng, block);
  }

 private:
  UprightCamera camera_;
  std::vector<std::vector<Rectangle>> parts_;
  std::vector<double> shares_;
};

// A straight corridor, seen along it; its end is out of sight. Points of each part are uniform in image 1
// over what it shows of that part.
//
// Building frame: the origin is at camera 1's height in the middle between the walls, z along the corridor.
class Corridor : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Real("corridor_width_m", &width_m_, {1e-3, 1e6}, "m", "distance of the walls"),
            Parameter::Real("corridor_height_m", &height_m_, {1e-3, 1e6}, "m", "floor to ceiling"),
            Parameter::Real("corridor_length_m", &length_m_, {1e-3, 1e6}, "m",
                            "reach of the points along the corridor"),
            Parameter::Real("camera_height_m", &camera_height_m_, {1e-3, 1e6}, "m",
                            "height above the floor, anywhere in the corridor's middle half"),
            Parameter::Real("max_heading_deg", &max_heading_deg_, {0.0, 45.0}, "deg",
                            "greatest angle to the corridor, uniform to either side"),
            Parameter::Real("walls_share", &walls_share_, {0.0, 1.0}, "", "share of points on both walls"),
            Parameter::Real("floor_share", &floor_share_, {0.0, 1.0}, "",
                            "share of points on the floor; the rest are on the ceiling")};
  }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream& rng) const override {
    if (camera_height_m_ >= height_m_) {
      throw InputError(
          fmt::format("camera_height_m: {} is not allowed; give less than corridor_height_m = {}",
                      camera_height_m_, height_m_));
    }
    const double ceiling_share = RestOfShares({"walls_share", walls_share_}, {"floor_share", floor_share_});
    const Eigen::Vector3d centre(rng.Uniform(-0.25 * width_m_, 0.25 * width_m_), 0.0, 0.0);
    const UprightCamera camera1(view.camera1, centre, DrawTurn(max_heading_deg_, rng));
    return std::make_unique<CorridorWorld>(camera1, Parts(),
                                           std::vector{walls_share_, floor_share_, ceiling_share});
  }

 private:
  std::vector<std::vector<Rectangle>> Parts() const {
    const double right = 0.5 * width_m_, floor = camera_height_m_, ceiling = camera_height_m_ - height_m_;
    const Rectangle left_wall{0, {-right, ceiling, -length_m_}, {-right, floor, length_m_}};
    const Rectangle right_wall{0, {right, ceiling, -length_m_}, {right, floor, length_m_}};
    return {{left_wall, right_wall},
            {{1, {-right, floor, -length_m_}, {right, floor, length_m_}}},
            {{1, {-right, ceiling, -length_m_}, {right, ceiling, length_m_}}}};
  }

  double width_m_ = 2.4, height_m_ = 2.6, length_m_ = 20.0, camera_height_m_ = 1.2, max_heading_deg_ = 5.0;
  double walls_share_ = 0.6, floor_share_ = 0.2;
};

}  // namespace

std::unique_ptr<SceneModel> MakeCorridor() { return std::make_unique<Corridor>(); }

}  // namespace rcme
