#include "simulator/outliers/outlier_laws.h"

namespace rcme {
namespace {

// The point in image 1 stays; the one in image 2 is uniform over the image.
class UniformOutliers : public OutlierLaw {
 public:
  void Replace(std::span<const std::uint32_t> points, const MatchedScene& matched,
               RandomStream& rng) const override {
    for (const std::uint32_t point : points) {
      matched.matches[point].x2_px = DrawPixel(matched.scene.camera2, rng);
    }
  }
};

}  // namespace

std::unique_ptr<OutlierLaw> MakeUniformOutliers() { return std::make_unique<UniformOutliers>(); }

}  // namespace rcme
