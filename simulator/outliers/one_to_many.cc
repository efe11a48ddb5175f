#include "parameters/input_error.h"
#include "simulator/outliers/outlier_laws.h"

namespace rcme {
namespace {

// A point in image 1 that has a true match is matched again, to anywhere in image 2; its noisy x1 is exactly
// that of the inlier. Each inlier in their (random) order gets outlier_fan_out wrong matches; after the last
// inlier the first follows again.
class OneToManyOutliers : public OutlierLaw {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Integer("outlier_fan_out", &fan_out_, {1, 1e6},
                               "wrong matches that share the image 1 point of one true match")};
  }

  void Replace(std::span<const std::uint32_t> points, const MatchedScene& matched,
               RandomStream& rng) const override {
    if (!points.empty() && matched.inliers.empty()) {
      throw InputError(
          "outlier_ratio: no true match is left, whose point in image 1 another match of 'one_to_many' could "
          "share; "
          "give less");
    }
    for (size_t k = 0; k < points.size(); ++k) {
      const size_t source = k / static_cast<size_t>(fan_out_) % matched.inliers.size();
      matched.matches[points[k]] = {matched.matches[matched.inliers[source]].x1_px,
                                    DrawPixel(matched.scene.camera2, rng)};
    }
  }

 private:
  int fan_out_ = 3;
};

}  // namespace

std::unique_ptr<OutlierLaw> MakeOneToManyOutliers() { return std::make_unique<OneToManyOutliers>(); }

}  // namespace rcme
