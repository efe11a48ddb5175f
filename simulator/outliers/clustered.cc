#include <fmt/format.h>

#include "parameters/input_error.h"
#include "simulator/outliers/outlier_laws.h"

namespace rcme {
namespace {

enum class ClusteredIn { kImage1, kImage2, kBoth };

// A Neyman-Scott process: a few cluster centres uniform over the image, each point at a normal offset from
// one of them. With clusters in image 1 the other end is uniform, with clusters in image 2 it stays. With
// clusters in both, a cluster has a centre in each image, and a match has the same offset from both, up to
// its own noise. This is a patch of image 1 found in the wrong place of image 2; all matches of a patch agree
// with a motion, though not with the true one.
//
// Offsets that leave an image are drawn again.
class ClusteredOutliers : public OutlierLaw {
 public:
  explicit ClusteredOutliers(ClusteredIn images) : images_(images) {}

  std::vector<Parameter> Parameters() override {
    return {Parameter::Integer("num_outlier_clusters", &num_clusters_, {1, 1e6}, "clusters of wrong matches"),
            Parameter::Real("outlier_spread_px", &spread_px_, {1e-3, 1e4}, "px",
                            "standard deviation of a cluster in x and y")};
  }

  void Replace(std::span<const std::uint32_t> points, const MatchedScene& matched,
               RandomStream& rng) const override {
    if (points.empty()) return;
    std::vector<Correspondence> centres(static_cast<size_t>(num_clusters_));
    for (Correspondence& centre : centres) {
      centre.x1_px = DrawPixel(matched.scene.camera1, rng);
      centre.x2_px = DrawPixel(matched.scene.camera2, rng);
    }
    for (const std::uint32_t point : points) {
      const Correspondence& centre = centres[rng.IntegerBelow(static_cast<std::uint32_t>(num_clusters_))];
      const Correspondence noise = ComputeMatchNoise(matched, point);
      matched.matches[point] = DrawMatch(matched.matches[point], noise, centre, matched.scene, rng);
    }
  }

 private:
  Correspondence DrawMatch(const Correspondence& now, const Correspondence& noise,
                           const Correspondence& centre, const ViewPair& view, RandomStream& rng) const {
    const Eigen::Vector2d offset_px = DrawOffsetInside(centre, view, rng);
    switch (images_) {
      case ClusteredIn::kImage1:
        return {centre.x1_px + offset_px, DrawPixel(view.camera2, rng)};
      case ClusteredIn::kImage2:
        return {now.x1_px, centre.x2_px + offset_px};
      case ClusteredIn::kBoth:
        break;
    }
    return {centre.x1_px + offset_px + noise.x1_px, centre.x2_px + offset_px + noise.x2_px};
  }

  Eigen::Vector2d DrawOffsetInside(const Correspondence& centre, const ViewPair& view,
                                   RandomStream& rng) const {
    for (int draw = 0; draw < kMaxOutlierDraws; ++draw) {
      const double x_px = spread_px_ * rng.Normal(), y_px = spread_px_ * rng.Normal();
      const Eigen::Vector2d offset_px(x_px, y_px);
      const bool is_in1 = images_ == ClusteredIn::kImage2 || view.camera1.IsInImage(centre.x1_px + offset_px);
      const bool is_in2 = images_ == ClusteredIn::kImage1 || view.camera2.IsInImage(centre.x2_px + offset_px);
      if (is_in1 && is_in2) return offset_px;
    }
    throw InputError(
        fmt::format("outlier_spread_px: {}: {} points of a cluster all lie outside the image; give "
                    "less than its size",
                    spread_px_, kMaxOutlierDraws));
  }

  ClusteredIn images_;
  int num_clusters_ = 5;
  double spread_px_ = 20.0;
};

}  // namespace

std::unique_ptr<OutlierLaw> MakeClusteredInImage1() {
  return std::make_unique<ClusteredOutliers>(ClusteredIn::kImage1);
}
std::unique_ptr<OutlierLaw> MakeClusteredInImage2() {
  return std::make_unique<ClusteredOutliers>(ClusteredIn::kImage2);
}
std::unique_ptr<OutlierLaw> MakeClusteredInBoth() {
  return std::make_unique<ClusteredOutliers>(ClusteredIn::kBoth);
}

}  // namespace rcme
