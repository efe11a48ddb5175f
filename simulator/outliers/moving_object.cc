#include <fmt/format.h>

#include <optional>

#include "parameters/input_error.h"
#include "simulator/motion_model.h"
#include "simulator/outliers/outlier_laws.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// A rigid motion between the two images: p -> R (p - centre) + centre + shift, in camera 1's frame (m).
struct MovingBody {
  Eigen::Vector3d centre_in_cam1, shift_m;
  Eigen::Matrix3d R;

  Eigen::Vector3d Moved(const Eigen::Vector3d& point_in_cam1) const {
    return R * (point_in_cam1 - centre_in_cam1) + centre_in_cam1 + shift_m;
  }
};

// An object with a rigid motion of its own, one per trial. It lies around a scene point; its points are
// normal around its centre. It turns about the centre by an angle uniform from 0 and shifts in a uniform
// direction. A match shows a point of the object before the motion in image 1 and after it in image 2, with
// the noise of the match that it replaces, or a share of it. (A law does not choose which matches become
// wrong. The object therefore has points of its own, which are compact in the image as the replaced scene
// points would not be.)
//
// By chance an object may move such that its matches also satisfy the camera's epipolar constraint.
//
// Points outside of an image are drawn again, and so is an object that is hardly in view.
class MovingObject : public OutlierLaw {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Real("object_size_m", &size_m_, {1e-9, 1e6}, "m",
                            "standard deviation of the object's points per axis"),
            Parameter::Real("object_shift_m", &shift_m_, {1e-9, 1e6}, "m",
                            "translation of the object between the images"),
            Parameter::Real("object_rotation_deg", &max_rotation_deg_, {0.0, 180.0}, "deg",
                            "greatest rotation about the object's centre, uniform from 0"),
            Parameter::Real("object_noise_share", &noise_share_, {0.0, 1.0}, "",
                            "noise of the object's matches over that of others; 0: they agree exactly")};
  }

  void Replace(std::span<const std::uint32_t> points, const MatchedScene& matched,
               RandomStream& rng) const override {
    if (points.empty()) return;
    const std::vector<Correspondence> exact = DrawObject(points.size(), matched.scene, matched.defects, rng);
    for (size_t k = 0; k < points.size(); ++k) {
      const Correspondence noise = ComputeMatchNoise(matched, points[k]);
      matched.matches[points[k]] = {exact[k].x1_px + noise_share_ * noise.x1_px,
                                    exact[k].x2_px + noise_share_ * noise.x2_px};
    }
  }

 private:
  MovingBody DrawBody(const Scene& scene, RandomStream& rng) const {
    const auto num_points = static_cast<std::uint32_t>(scene.points_in_cam1.size());
    MovingBody body;
    body.centre_in_cam1 = scene.points_in_cam1[rng.IntegerBelow(num_points)];
    body.R = DrawRotation(RadFromDeg(max_rotation_deg_), rng);
    body.shift_m = shift_m_ * DrawDirection(rng);
    return body;
  }

  std::optional<Correspondence> DrawMatch(const MovingBody& body, const ViewPair& view,
                                          const CameraDefects& defects, RandomStream& rng) const {
    const double x = rng.Normal(), y = rng.Normal(), z = rng.Normal();
    const Eigen::Vector3d before = body.centre_in_cam1 + size_m_ * Eigen::Vector3d(x, y, z);
    const Eigen::Vector3d after = body.Moved(before);
    if (!view.camera1.Shows(before) || !view.camera2.Shows(view.InCamera2(after))) return std::nullopt;
    // While an image is read the object stands still.
    return Correspondence{ImagedMatch(view, defects, before).x1_px, ImagedMatch(view, defects, after).x2_px};
  }

  // The exact matches of one object: the first of up to 200 objects of which about one point in 20 or more is
  // seen.
  std::vector<Correspondence> DrawObject(size_t num_matches, const Scene& scene, const CameraDefects& defects,
                                         RandomStream& rng) const {
    constexpr int kMaxObjects = 200;
    constexpr size_t kMinDraws = 100, kMaxDrawsPerMatch = 20;
    for (int object = 0; object < kMaxObjects; ++object) {
      const MovingBody body = DrawBody(scene, rng);
      std::vector<Correspondence> matches;
      for (size_t draw = 0; draw < kMinDraws + kMaxDrawsPerMatch * num_matches; ++draw) {
        if (const std::optional<Correspondence> match = DrawMatch(body, scene, defects, rng))
          matches.push_back(*match);
        if (matches.size() == num_matches) return matches;
      }
    }
    throw InputError(
        fmt::format("object_shift_m: {}, object_size_m: {}: of {} objects too little is seen before "
                    "and after they moved; give a smaller shift or size",
                    shift_m_, size_m_, kMaxObjects));
  }

  double size_m_ = 0.3, shift_m_ = 0.3, max_rotation_deg_ = 10.0, noise_share_ = 1.0;
};

}  // namespace

std::unique_ptr<OutlierLaw> MakeMovingObject() { return std::make_unique<MovingObject>(); }

}  // namespace rcme
