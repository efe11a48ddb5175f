#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "parameters/input_error.h"
#include "simulator/scenes/scenes.h"
#include "simulator/scenes/surfaces.h"
#include "simulator/scenes/view_volume.h"
#include "stats/portable_math.h"

namespace rcme {
namespace {

// Part 0: the plane left of the edge. Part 1: the plane right of it. The edge is vertical and crosses the
// optical axis of camera 1. angles[part] is the angle between the plane and the line from the edge to the
// camera.
class TwoPlanesWorld : public World {
 public:
  TwoPlanesWorld(const SceneCamera& camera1, double edge_depth_m, const std::array<CosSin, 2>& angles,
                 double first_plane_share)
      : camera_(camera1),
        edge_depth_m_(edge_depth_m),
        angles_(angles),
        first_plane_share_(first_plane_share) {}

  std::vector<double> PartShares() const override { return {first_plane_share_, 1.0 - first_plane_share_}; }

  // The points where the rays of pixels uniform over image 1 meet the plane. Points of the plane at s metres
  // from the edge have depth edge_depth_m - s cos and lie s sin to the side; their ratio must equal |x / z|
  // of the ray.
  void DrawCandidates(size_t part, size_t, RandomStream& rng, PointBlock* block) const override {
    RayBlock rays;
    DrawRays(camera_, rng, &rays);
    const double cos = angles_[part].cos, sin = angles_[part].sin, edge_m = edge_depth_m_ * sin;
    const double side = part == 0 ? -1.0 : 1.0;
    RayBlock::Numbers depths_m;
    for (size_t i = 0; i < PointBlock::kSize; ++i) {
      const double ratio = side * rays.x[i], denominator = sin + ratio * cos, depth_m = edge_m / denominator;
      const bool is_missed = (ratio < 0.0) | (denominator < 1e-9);
      depths_m[i] = is_missed ? std::numeric_limits<double>::infinity() : depth_m;
    }
    SetOnRays(rays, depths_m, block);
  }

 private:
  SceneCamera camera_;
  double edge_depth_m_;
  std::array<CosSin, 2> angles_;
  double first_plane_share_;
};

// Two walls that meet in a vertical edge: the corner of a room or of a house.
class TwoPlanes : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Real("edge_depth_m", &edge_depth_m_, {1e-6, 1e9}, "m",
                            "depth of the edge on camera 1's optical axis"),
            Parameter::Real(
                "dihedral_deg", &dihedral_deg_, {2.0, 358.0}, "deg",
                "angle on the camera's side: below 180 a room's inner corner, above a house's outer one"),
            Parameter::Real(
                "max_corner_turn_deg", &max_corner_turn_deg_, {0.0, 89.0}, "deg",
                "greatest turn about the edge, uniform to either side; 0: symmetric to the optical axis"),
            Parameter::Real("first_plane_share", &first_plane_share_, {0.0, 1.0}, "",
                            "share of points on the left plane")};
  }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream& rng) const override {
    const double half_deg = 0.5 * dihedral_deg_;
    if (max_corner_turn_deg_ >= std::min(half_deg, 180.0 - half_deg)) {
      throw InputError(
          fmt::format("max_corner_turn_deg: {} is not allowed; with dihedral_deg = {} give less than {}, or "
                      "the camera may see "
                      "one of the planes from behind",
                      max_corner_turn_deg_, dihedral_deg_, std::min(half_deg, 180.0 - half_deg)));
    }
    const double turn = DrawTurn(max_corner_turn_deg_, rng), half_turn = half_deg / 360.0;
    return std::make_unique<TwoPlanesWorld>(
        view.camera1, edge_depth_m_,
        std::array{PortableCosSinOfTurn(half_turn - turn), PortableCosSinOfTurn(half_turn + turn)},
        first_plane_share_);
  }

 private:
  double edge_depth_m_ = 6.0, dihedral_deg_ = 90.0, max_corner_turn_deg_ = 20.0, first_plane_share_ = 0.5;
};

}  // namespace

std::unique_ptr<SceneModel> MakeTwoPlanes() { return std::make_unique<TwoPlanes>(); }

}  // namespace rcme
