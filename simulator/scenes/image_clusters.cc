#include <fmt/format.h>

#include <cmath>

#include "parameters/input_error.h"
#include "simulator/scenes/scenes.h"
#include "simulator/scenes/view_volume.h"
#include "stats/portable_math.h"

namespace rcme {
namespace {

constexpr int kMaxTriesPerParent = 10'000;

enum class ClusterShape { kGaussian, kDisc };

// An offset from the parent (px): spread times a standard normal or a point of the unit disc.
Eigen::Vector2d DrawOffset(ClusterShape shape, RandomStream& rng) {
  if (shape == ClusterShape::kGaussian) {
    const double x = rng.Normal();
    return {x, rng.Normal()};
  }
  const double radius = std::sqrt(rng.Uniform());  // the area within the radius is uniform
  const CosSin angle = PortableCosSinOfTurn(rng.Uniform());
  return {radius * angle.cos, radius * angle.sin};
}

// Part 0: the background, a uniform volume. Part 1: points around parents, each parent with equal
// probability.
class ImageClustersWorld : public World {
 public:
  ImageClustersWorld(const SceneCamera& camera1, const DepthRange& depths, ClusterShape shape,
                     double spread_px, double clustered_share, std::vector<Eigen::Vector2d> parents_px)
      : camera_(camera1),
        depths_(depths),
        shape_(shape),
        spread_px_(spread_px),
        clustered_share_(clustered_share),
        parents_px_(std::move(parents_px)) {}

  std::vector<double> PartShares() const override { return {1.0 - clustered_share_, clustered_share_}; }

  void DrawCandidates(size_t part, size_t, RandomStream& rng, PointBlock* block) const override {
    if (part == 0) return DrawInViewVolume(camera_, depths_, rng, block);
    for (size_t i = 0; i < PointBlock::kSize; ++i) {
      const size_t parent = rng.IntegerBelow(static_cast<std::uint32_t>(parents_px_.size()));
      const Eigen::Vector2d x_px = parents_px_[parent] + spread_px_ * DrawOffset(shape_, rng);
      block->Set(i, depths_.Draw(rng) * camera_.Ray(x_px));
    }
  }

 private:
  SceneCamera camera_;
  DepthRange depths_;
  ClusterShape shape_;
  double spread_px_, clustered_share_;
  std::vector<Eigen::Vector2d> parents_px_;
};

// Matches cluster in image 1 as detections do, while depths stay those of a uniform volume; clustered_share
// runs from even to fully clustered. A cluster process with fixed numbers of parents and points: Thomas
// (Gaussian) or Matern (disc). With clustered_share 0 the scene is exactly that of uniform_volume.
class ImageClusters : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = rcme::Parameters(depths_);
    all.insert(
        all.end(),
        {Parameter::Integer("num_clusters", &num_clusters_, {1, 100'000}, "clusters in image 1"),
         Parameter::Real("cluster_spread_px", &spread_px_, {1e-6, 1e5}, "px",
                         "gaussian: standard deviation in x and y; disc: radius"),
         Parameter::Real("clustered_share", &clustered_share_, {0.0, 1.0}, "",
                         "share of points in clusters; the rest are uniform over image 1"),
         Parameter::Choice<ClusterShape>(
             "cluster_shape", &shape_, {{"gaussian", ClusterShape::kGaussian}, {"disc", ClusterShape::kDisc}},
             "Gaussian (Thomas) or uniform in a disc (Matern)")});
    return all;
  }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream& rng) const override {
    depths_.Check();
    std::vector<Eigen::Vector2d> parents_px;
    const int num_parents = clustered_share_ > 0.0 ? num_clusters_ : 0;
    for (int k = 0; k < num_parents; ++k) parents_px.push_back(DrawParent(view, rng));
    return std::make_unique<ImageClustersWorld>(view.camera1, depths_, shape_, spread_px_, clustered_share_,
                                                std::move(parents_px));
  }

 private:
  // Uniform over the part of image 1 whose points at the middle depth are visible in image 2.
  Eigen::Vector2d DrawParent(const ViewPair& view, RandomStream& rng) const {
    for (int tries = 0; tries < kMaxTriesPerParent; ++tries) {
      const Eigen::Vector3d parent_in_cam1 = depths_.Middle() * DrawRay(view.camera1, rng);
      if (view.Sees(parent_in_cam1)) return view.camera1.Project(parent_in_cam1);
    }
    throw InputError(fmt::format(
        "num_clusters: no place for a cluster found in {} tries: no point seen in both images in the middle "
        "of min_depth_m = {} "
        "and max_depth_m = {}; make the motion smaller or the depths larger",
        kMaxTriesPerParent, depths_.min_depth_m, depths_.max_depth_m));
  }

  DepthRange depths_;
  int num_clusters_ = 10;
  double spread_px_ = 20.0;
  double clustered_share_ = 0.8;
  ClusterShape shape_ = ClusterShape::kGaussian;
};

}  // namespace

std::unique_ptr<SceneModel> MakeImageClusters() { return std::make_unique<ImageClusters>(); }

}  // namespace rcme
