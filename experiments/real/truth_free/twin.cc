#include "experiments/real/truth_free/twin.h"

#include <cmath>
#include <optional>

#include "estimator/geometry/sampson.h"
#include "estimator/noise_scale.h"
#include "experiments/data/data_source.h"
#include "simulator/noise/displacement_field.h"
#include "stats/fnv1a.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

constexpr double kNormalQuartile = 0.6744897501960817;  // median of |Z|

// Key of a key point's random stream: hash of its image and position, folded to 48 bits.
std::uint64_t HashKeyPoint(const std::string& image, const Eigen::Vector2d& x_px) {
  Fnv1a hash;
  hash.Add(image);
  for (const double x : x_px) hash.Add(x);
  return ((hash.value() ^ hash.value() >> 32) * 0x9e3779b97f4a7c15) >> 16;
}

// The field of one image of a twin, or none.
class FieldOfImage {
 public:
  FieldOfImage(const TwinField& field, double sigma_px, const std::string& image, std::uint64_t seed,
               std::uint32_t twin)
      : sigma_px_(sigma_px), share_(field.share) {
    if (share_ == 0.0) return;
    RandomStream rng = StreamFor({seed, HashToStreamKey(image), twin, 0}, StreamPurpose::kNoise);
    field_.emplace(field.reach_px, rng);
  }

  // Replaces a share of the key point's own noise, of variance (scale sigma)^2, by the field.
  Eigen::Vector2d Mix(const Eigen::Vector2d& own, const Eigen::Vector2d& x_px, double scale) const {
    if (!field_) return own;
    return std::sqrt(1.0 - share_) * own + std::sqrt(share_) * scale * sigma_px_ * field_->At(x_px);
  }

 private:
  double sigma_px_, share_;
  std::optional<DisplacementField> field_;
};

}  // namespace

Eigen::Matrix3d ComputeFundamental(const MotionProblem& problem, const RelativePose& pose) {
  return FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2);
}

Correspondence Snapped(const Eigen::Matrix3d& F, Correspondence match) {
  for (int round = 0; round < 2; ++round) {
    const Eigen::Vector4d delta = SampsonVector(F, match);
    match.x1_px += delta.head<2>();
    match.x2_px += delta.tail<2>();
  }
  return match;
}

double EstimateNoise(const MotionProblem& problem, const MotionEstimate& estimate) {
  if (std::isfinite(estimate.sigma_estimated_px)) return estimate.sigma_estimated_px;
  const Eigen::Matrix3d F = ComputeFundamental(problem, estimate.cam2_from_cam1);
  std::vector<double> sizes;
  for (const int index : estimate.inliers) {
    const auto i = static_cast<size_t>(index);
    sizes.push_back(std::sqrt(SquaredSampsonDistance(F, problem.matches[i])) / NoiseScaleAt(problem, i));
  }
  return ComputeMedian(std::move(sizes)) / kNormalQuartile;
}

NamedPair MakeTwin(const NamedPair& pair, const MotionEstimate& estimate, std::uint64_t seed,
                   std::uint32_t twin, const TwinField& field) {
  const Eigen::Matrix3d F = ComputeFundamental(pair.problem, estimate.cam2_from_cam1);
  const double sigma_px = EstimateNoise(pair.problem, estimate);
  const auto noise_of = [&](const std::string& image, const Eigen::Vector2d& x_px, double scale) {
    RandomStream rng = StreamFor({seed, HashKeyPoint(image, x_px), twin, 0}, StreamPurpose::kNoise);
    const double x = rng.Normal(), y = rng.Normal();
    return Eigen::Vector2d(scale * sigma_px * x, scale * sigma_px * y);
  };
  const std::string image1 = pair.image1.empty() ? pair.name + "/1" : pair.image1;
  const std::string image2 = pair.image2.empty() ? pair.name + "/2" : pair.image2;
  const FieldOfImage field1(field, sigma_px, image1, seed, twin), field2(field, sigma_px, image2, seed, twin);
  NamedPair made = pair;
  for (const int i : estimate.inliers) {
    Correspondence& match = made.problem.matches[static_cast<size_t>(i)];
    const Correspondence observed = match;
    const double scale = NoiseScaleAt(pair.problem, static_cast<size_t>(i));
    match = Snapped(F, match);
    match.x1_px += field1.Mix(noise_of(image1, observed.x1_px, scale), observed.x1_px, scale);
    match.x2_px += field2.Mix(noise_of(image2, observed.x2_px, scale), observed.x2_px, scale);
  }
  return made;
}

}  // namespace rcme
