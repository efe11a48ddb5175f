#include "simulator/scenes/scenes.h"
#include "simulator/scenes/shares.h"
#include "simulator/scenes/surfaces.h"
#include "simulator/scenes/view_volume.h"

namespace rcme {
namespace {

// Depth of the farthest points beyond the street, over street_length_m.
constexpr double kStreetFarSpan = 5.0;

struct StreetSize {
  double camera_height_m = 1.65;  // of a camera on the roof of a car (KITTI)
  double facade_distance_m = 8.0, facade_height_m = 10.0, street_length_m = 60.0;
};

// Part 0: the road, 1: the facades, 2: far points. The street is convex, so there is no occlusion.
class StreetWorld : public World {
 public:
  StreetWorld(const SceneCamera& camera1, double turn, const StreetSize& size, std::vector<double> shares)
      : camera_(camera1),
        size_(size),
        upright_(camera1, Eigen::Vector3d::Zero(), turn),
        shares_(std::move(shares)) {
    const double right = size.facade_distance_m, length = size.street_length_m;
    const double road = size.camera_height_m, roof = road - size.facade_height_m;
    road_ = {{1, {-right, road, -length}, {right, road, length}}};
    facades_ = {{0, {-right, roof, -length}, {-right, road, length}},
                {0, {right, roof, -length}, {right, road, length}}};
  }

  std::vector<double> PartShares() const override { return shares_; }

  void DrawCandidates(size_t part, size_t, RandomStream& rng, PointBlock* block) const override {
    if (part < 2) return upright_.DrawPoints(part == 0 ? road_ : facades_, rng, block);
    for (size_t i = 0; i < PointBlock::kSize; ++i) block->Set(i, DrawFarPoint(rng));
  }

 private:
  // Uniform in depth, across image 1, and in height up to that of the facades.
  Eigen::Vector3d DrawFarPoint(RandomStream& rng) const {
    const double depth_m = rng.Uniform(size_.street_length_m, kStreetFarSpan * size_.street_length_m);
    const double height_m = rng.Uniform(0.0, size_.facade_height_m);
    return {depth_m * DrawRay(camera_, rng).x(), size_.camera_height_m - height_m, depth_m};
  }

  SceneCamera camera_;
  StreetSize size_;
  UprightCamera upright_;
  std::vector<Rectangle> road_, facades_;
  std::vector<double> shares_;
};

// A street seen from a car in its middle: road, facades on both sides, and trees and houses beyond its end.
// Points on road and facades are uniform in image 1 over what it shows of them.
//
// Building frame: the origin is at camera 1, z along the street.
class Street : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {
        Parameter::Real("camera_height_m", &size_.camera_height_m, {1e-3, 1e6}, "m", "height above the road"),
        Parameter::Real("facade_distance_m", &size_.facade_distance_m, {1e-3, 1e6}, "m",
                        "distance from camera 1, in the middle of the street"),
        Parameter::Real("facade_height_m", &size_.facade_height_m, {1e-3, 1e6}, "m", "height above the road"),
        Parameter::Real("street_length_m", &size_.street_length_m, {1e-3, 1e6}, "m",
                        "length ahead of camera 1; far points are one to five times as deep"),
        Parameter::Real("max_heading_deg", &max_heading_deg_, {0.0, 45.0}, "deg",
                        "greatest angle to the street, uniform to either side"),
        Parameter::Real("road_share", &road_share_, {0.0, 1.0}, "", "share of points on the road"),
        Parameter::Real("facade_share", &facade_share_, {0.0, 1.0}, "",
                        "share of points on both facades; the rest are far away")};
  }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream& rng) const override {
    const double far_share = RestOfShares({"road_share", road_share_}, {"facade_share", facade_share_});
    return std::make_unique<StreetWorld>(view.camera1, DrawTurn(max_heading_deg_, rng), size_,
                                         std::vector{road_share_, facade_share_, far_share});
  }

 private:
  StreetSize size_;
  double max_heading_deg_ = 3.0, road_share_ = 0.3, facade_share_ = 0.5;
};

}  // namespace

std::unique_ptr<SceneModel> MakeStreet() { return std::make_unique<Street>(); }

}  // namespace rcme
