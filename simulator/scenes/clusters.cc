#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "parameters/input_error.h"
#include "simulator/scenes/scenes.h"
#include "simulator/scenes/view_volume.h"

namespace rcme {
namespace {

constexpr int kMaxTriesPerCentre = 10'000;

// Part 0: the background, a uniform volume. Part k: the points around centre k - 1, Gaussian.
class ClustersWorld : public World {
 public:
  ClustersWorld(const SceneCamera& camera1, const DepthRange& depths, double spread_m,
                std::vector<double> shares, std::vector<Eigen::Vector3d> centres_in_cam1)
      : camera_(camera1),
        depths_(depths),
        spread_m_(spread_m),
        shares_(std::move(shares)),
        centres_in_cam1_(std::move(centres_in_cam1)) {}

  std::vector<double> PartShares() const override { return shares_; }

  void DrawCandidates(size_t part, size_t, RandomStream& rng, PointBlock* block) const override {
    if (part == 0) return DrawInViewVolume(camera_, depths_, rng, block);
    std::array<double, 3 * PointBlock::kSize> normals;
    rng.FillNormal(normals);
    for (size_t i = 0; i < PointBlock::kSize; ++i) {
      const Eigen::Vector3d offset(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
      block->Set(i, centres_in_cam1_[part - 1] + spread_m_ * offset);
    }
  }

 private:
  SceneCamera camera_;
  DepthRange depths_;
  double spread_m_;
  std::vector<double> shares_;
  std::vector<Eigen::Vector3d> centres_in_cam1_;
};

// Clusters in space: highly textured objects in front of a less textured background.
class Clusters : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = rcme::Parameters(depths_);
    all.insert(all.end(),
               {Parameter::Integer("num_clusters", &num_clusters_, {1, 1000},
                                   "clusters, their centres between the depths"),
                Parameter::Real("cluster_spread_m", &spread_m_, {1e-9, 1e6}, "m",
                                "standard deviation of a cluster per axis"),
                Parameter::Real("clustered_share", &clustered_share_, {0.0, 1.0}, "",
                                "share of points in clusters; the rest fill the volume"),
                Parameter::RealOrWord(
                    "largest_share", &largest_share_, {0.0, 1.0}, "equal", "",
                    "share of clustered points in one cluster; the others share the rest equally")});
    return all;
  }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream& rng) const override {
    depths_.Check();
    std::vector<double> shares = PartShares();
    std::vector<Eigen::Vector3d> centres_in_cam1;
    for (int k = 0; k < num_clusters_; ++k) centres_in_cam1.push_back(DrawCentre(view, rng));
    return std::make_unique<ClustersWorld>(view.camera1, depths_, spread_m_, std::move(shares),
                                           std::move(centres_in_cam1));
  }

 private:
  // Shares of the background, the largest cluster, the other clusters.
  std::vector<double> PartShares() const {
    const double equal = 1.0 / num_clusters_;
    const double largest = std::isnan(largest_share_) ? equal : largest_share_;
    if (largest < equal * (1.0 - 1e-9) || (num_clusters_ == 1 && largest != 1.0)) {
      throw InputError(fmt::format("largest_share: {} is not allowed; with num_clusters = {} give {} {}",
                                   largest, num_clusters_, num_clusters_ == 1 ? "equal or" : "at least",
                                   equal));
    }
    std::vector<double> shares = {1.0 - clustered_share_, clustered_share_ * largest};
    for (int k = 1; k < num_clusters_; ++k) {
      shares.push_back(clustered_share_ * (1.0 - largest) / (num_clusters_ - 1));
    }
    return shares;
  }

  // Uniform over the part of the volume that both images show.
  Eigen::Vector3d DrawCentre(const ViewPair& view, RandomStream& rng) const {
    for (int tries = 0; tries < kMaxTriesPerCentre; ++tries) {
      const Eigen::Vector3d ray = DrawRay(view.camera1, rng);
      const Eigen::Vector3d centre_in_cam1 = depths_.Draw(rng) * ray;
      if (view.Sees(centre_in_cam1)) return centre_in_cam1;
    }
    throw InputError(
        fmt::format("num_clusters: no place for the centre of a cluster found in {} tries: no point seen in "
                    "both images between "
                    "min_depth_m = {} and max_depth_m = {}; make the motion smaller or the depths larger",
                    kMaxTriesPerCentre, depths_.min_depth_m, depths_.max_depth_m));
  }

  DepthRange depths_;
  int num_clusters_ = 5;
  double spread_m_ = 0.2;
  double clustered_share_ = 0.8;
  double largest_share_ = std::numeric_limits<double>::quiet_NaN();  // NaN: equal
};

}  // namespace

std::unique_ptr<SceneModel> MakeClusters() { return std::make_unique<Clusters>(); }

}  // namespace rcme
