
#include "simulator/scenes/scenes.h"
#include "simulator/scenes/view_volume.h"
#include "stats/portable_math.h"

namespace rcme {
namespace {

// A plane {X : normal' X = distance_m} in camera 1's frame; the normal is a unit vector pointing away from
// the camera.
struct Plane {
  Eigen::Vector3d normal;
  double distance_m;
};

// Part 0: on the plane. Part 1: off it.
class PlaneWorld : public PointwiseWorld {
 public:
  PlaneWorld(const SceneCamera& camera1, const Plane& plane, double off_plane_share, double off_plane_m)
      : camera_(camera1), plane_(plane), off_plane_share_(off_plane_share), off_plane_m_(off_plane_m) {}

  std::vector<double> PartShares() const override { return {1.0 - off_plane_share_, off_plane_share_}; }

 private:
  // The point where the ray of a pixel uniform over image 1 meets the plane; UnseenPoint() beyond the plane's
  // horizon.
  Eigen::Vector3d DrawCandidate(size_t part, RandomStream& rng) const override {
    const Eigen::Vector3d ray = DrawRay(camera_, rng);
    const double offset_m = part == 0 ? 0.0 : rng.Uniform(-off_plane_m_, off_plane_m_);
    const double cos_incidence = plane_.normal.dot(ray);  // times the ray's length
    if (cos_incidence < 1e-9) return UnseenPoint();
    return plane_.distance_m / cos_incidence * ray + offset_m * plane_.normal;
  }

  SceneCamera camera_;
  Plane plane_;
  double off_plane_share_, off_plane_m_;
};

// A plane, tilted about any axis in the image, and points off it. With few points off it the motion is hard
// to distinguish from the second motion of the same homography (Type B).
class PlaneScene : public SceneModel {
 public:
  explicit PlaneScene(double off_plane_share) : off_plane_share_(off_plane_share) {}

  std::vector<Parameter> Parameters() override {
    return {Parameter::Real("plane_depth_m", &plane_depth_m_, {1e-6, 1e9}, "m",
                            "depth on camera 1's optical axis"),
            Parameter::Real("plane_tilt_deg", &plane_tilt_deg_, {0.0, 89.0}, "deg",
                            "angle of the plane's normal to the optical axis, towards any side"),
            Parameter::Real("off_plane_share", &off_plane_share_, {0.0, 1.0}, "",
                            "share of points off the plane"),
            Parameter::Real("off_plane_m", &off_plane_m_, {1e-9, 1e9}, "m",
                            "greatest distance from the plane, uniform to either side")};
  }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream& rng) const override {
    const CosSin tilt = PortableCosSinOfTurn(plane_tilt_deg_ / 360.0);
    const CosSin azimuth = PortableCosSinOfTurn(rng.Uniform());
    const Plane plane{{tilt.sin * azimuth.cos, tilt.sin * azimuth.sin, tilt.cos}, plane_depth_m_ * tilt.cos};
    return std::make_unique<PlaneWorld>(view.camera1, plane, off_plane_share_, off_plane_m_);
  }

 private:
  double plane_depth_m_ = 5.0, plane_tilt_deg_ = 30.0;
  double off_plane_share_, off_plane_m_ = 1.0;
};

}  // namespace

std::unique_ptr<SceneModel> MakePlane() { return std::make_unique<PlaneScene>(0.0); }
std::unique_ptr<SceneModel> MakePlaneAndParallax() { return std::make_unique<PlaneScene>(0.2); }

}  // namespace rcme
