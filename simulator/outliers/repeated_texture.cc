#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "parameters/input_error.h"
#include "simulator/outliers/outlier_laws.h"

namespace rcme {
namespace {

// The point in image 2 is that of another repetition: the scene point shifted by a whole number of steps
// along each direction of repetition. The shift is uniform among those of at most max_repeat_steps each that
// are not zero and whose point image 2 shows. The match keeps its noise.
class RepeatedTexture : public OutlierLaw {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::RealOrWord(
                "repeat_step_m", &step_m_, {1e-9, 1e6}, "scene", "m",
                "step of the repetitions along camera 1's x axis; scene: the scene's own steps"),
            Parameter::Integer("max_repeat_steps", &max_steps_, {1, 1000},
                               "most steps between the true and the wrong repetition")};
  }

  void Replace(std::span<const std::uint32_t> points, const MatchedScene& matched,
               RandomStream& rng) const override {
    if (points.empty()) return;
    const Scene& scene = matched.scene;
    const std::vector<Eigen::Vector3d> steps_m = Steps(scene);
    for (const std::uint32_t point : points) {
      const Eigen::Vector3d& true_in_cam1 = ShownPoint(matched, point);
      const Eigen::Vector3d shift_m = DrawShiftInView(true_in_cam1, steps_m, scene, rng);
      const Correspondence noise = ComputeMatchNoise(matched, point);
      const Correspondence other = ImagedMatch(scene, matched.defects, true_in_cam1 + shift_m);
      matched.matches[point].x2_px = other.x2_px + noise.x2_px;
      if (IsInEpipolarPlane(true_in_cam1, shift_m, scene)) matched.is_undetectable[point] = true;
    }
  }

 private:
  std::vector<Eigen::Vector3d> Steps(const Scene& scene) const {
    if (!std::isnan(step_m_)) return {step_m_ * Eigen::Vector3d::UnitX()};
    if (!scene.repeat_steps_m.empty()) return scene.repeat_steps_m;
    throw InputError(
        "repeat_step_m: 'scene' is not allowed here, nothing in this scene is repeated; give the distance of "
        "the "
        "repetitions");
  }

  Eigen::Vector3d DrawShift(const std::vector<Eigen::Vector3d>& steps_m, RandomStream& rng) const {
    Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& step_m : steps_m) {
      shift_m += (static_cast<int>(rng.IntegerBelow(2u * static_cast<std::uint32_t>(max_steps_) + 1u)) -
                  max_steps_) *
                 step_m;
    }
    return shift_m;
  }

  Eigen::Vector3d DrawShiftInView(const Eigen::Vector3d& from_in_cam1,
                                  const std::vector<Eigen::Vector3d>& steps_m, const ViewPair& view,
                                  RandomStream& rng) const {
    for (int draw = 0; draw < kMaxOutlierDraws; ++draw) {
      const Eigen::Vector3d shift_m = DrawShift(steps_m, rng);
      const Eigen::Vector3d in_cam2 = view.InCamera2(from_in_cam1 + shift_m);
      if (view.camera2.Shows(in_cam2) && !shift_m.isZero(0.0)) return shift_m;
    }
    throw InputError(
        fmt::format("max_repeat_steps: {}: none of {} other repetitions of a point lies in image 2; "
                    "give a smaller repeat_step_m or a scene with smaller steps",
                    max_steps_, kMaxOutlierDraws));
  }

  // Whether the other repetition lies, up to rounding, in the plane of the point and the two camera centres,
  // as when the camera moves along the steps.
  static bool IsInEpipolarPlane(const Eigen::Vector3d& point_in_cam1, const Eigen::Vector3d& shift_m,
                                const ViewPair& view) {
    if (!view.IsDirectionDefined()) return false;
    const RelativePose& pose = view.cam2_from_cam1_true;
    const Eigen::Vector3d towards_camera2 = -pose.R.transpose() * pose.t;
    const double volume = towards_camera2.cross(point_in_cam1).dot(shift_m);
    return std::abs(volume) <= 1e-12 * point_in_cam1.norm() * shift_m.norm();
  }

  double step_m_ = std::numeric_limits<double>::quiet_NaN();  // the scene's
  int max_steps_ = 2;
};

}  // namespace

std::unique_ptr<OutlierLaw> MakeRepeatedTexture() { return std::make_unique<RepeatedTexture>(); }

}  // namespace rcme
