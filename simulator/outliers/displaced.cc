#include <fmt/format.h>

#include <cmath>

#include "parameters/input_error.h"
#include "simulator/outliers/outlier_laws.h"
#include "stats/portable_math.h"

namespace rcme {
namespace {

// The point in image 2 is the noisy true one plus a shift, uniform in an annulus. Shifts that leave the image
// (before noise) are drawn again.
class DisplacedOutliers : public OutlierLaw {
 public:
  std::vector<Parameter> Parameters() override {
    return {MinShiftParameter(&min_shift_px_),
            Parameter::Real("outlier_max_shift_px", &max_shift_px_, {0.0, 1e5}, "px",
                            "greatest distance of the wrong from the true point")};
  }

  void Replace(std::span<const std::uint32_t> points, const MatchedScene& matched,
               RandomStream& rng) const override {
    if (!points.empty() && min_shift_px_ > max_shift_px_) {
      throw InputError(
          fmt::format("outlier_min_shift_px: {} is not allowed; give at most outlier_max_shift_px = {}",
                      min_shift_px_, max_shift_px_));
    }
    const Scene& scene = matched.scene;
    for (const std::uint32_t point : points) {
      const Correspondence& exact = matched.exact[point];
      matched.matches[point].x2_px += DrawShiftInside(scene.camera2, exact.x2_px, rng);
    }
  }

 private:
  Eigen::Vector2d DrawShiftInside(const SceneCamera& camera2, const Eigen::Vector2d& from_px,
                                  RandomStream& rng) const {
    for (int draw = 0; draw < kMaxOutlierDraws; ++draw) {
      const Eigen::Vector2d shift_px = DrawShift(rng);
      if (camera2.IsInImage(from_px + shift_px)) return shift_px;
    }
    throw InputError(
        fmt::format("outlier_min_shift_px: {}, outlier_max_shift_px: {}: {} shifts all lead out of "
                    "image 2 ({} x {} px); give smaller ones",
                    min_shift_px_, max_shift_px_, kMaxOutlierDraws, camera2.width, camera2.height));
  }

  // The area within a radius grows with its square, so the square is drawn uniformly.
  Eigen::Vector2d DrawShift(RandomStream& rng) const {
    const double radius_px =
        std::sqrt(rng.Uniform(min_shift_px_ * min_shift_px_, max_shift_px_ * max_shift_px_));
    const CosSin direction = PortableCosSinOfTurn(rng.Uniform());
    return {radius_px * direction.cos, radius_px * direction.sin};
  }

  double min_shift_px_ = 5.0, max_shift_px_ = 50.0;
};

}  // namespace

std::unique_ptr<OutlierLaw> MakeDisplacedOutliers() { return std::make_unique<DisplacedOutliers>(); }

}  // namespace rcme
