#include "experiments/real/truth_free/twin_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimator/geometry/triangulation.h"
#include "experiments/real/truth_free/noise_fit.h"
#include "parameters/input_error.h"
#include "simulator/severity/homography_share.h"
#include "stats/constants.h"
#include "stats/fnv1a.h"
#include "stats/median_ratio.h"
#include "stats/order_statistic.h"
#include "stats/spatial_pattern.h"

namespace rcme {
namespace {

constexpr double kFarthestDepth = 1e3;  // baselines; beyond, depth is as good as infinite

// Medians over the templates of a scene.
class LayoutFit {
 public:
  void Add(const TrialData& exact, double noise_px, RandomStream& rng) {
    const MotionProblem& problem = exact.problem;
    const RelativePose& pose = *exact.truth.cam2_from_cam1_true;
    std::vector<Eigen::Vector3d> points_in_cam1;
    std::vector<Eigen::Vector2d> key_points;
    std::vector<Correspondence> wrong;
    std::vector<double> parallaxes;
    for (size_t i = 0; i < problem.matches.size(); ++i) {
      const Correspondence& match = problem.matches[i];
      if (!exact.truth.is_inlier_true[i]) {
        wrong.push_back(match);
        continue;
      }
      const Eigen::Vector3d ray1 = problem.camera1.Ray(match.x1_px), ray2 = problem.camera2.Ray(match.x2_px);
      const double depth = 1.0 / std::max(InverseDepth(pose, ray1, ray2), 1.0 / kFarthestDepth);
      key_points.push_back(match.x1_px);
      points_in_cam1.push_back(depth * ray1);
      depths_.push_back(depth);
      parallaxes.push_back(kDegPerRad * AngleBetween(pose.R * ray1, ray2));
    }
    num_matches_.push_back(static_cast<double>(problem.matches.size()));
    wrong_shares_.push_back(static_cast<double>(wrong.size()) / num_matches_.back());
    agreeing_.push_back(AgreeingShare(wrong));
    rotations_.push_back(kDegPerRad * RotationAngleBetween(pose.R, Eigen::Matrix3d::Identity()));
    parallaxes_.push_back(ComputeMedian(std::move(parallaxes)));
    forwardness_.push_back(std::abs(pose.t.z()));
    const ViewPair view{problem.camera1, problem.camera2, pose, 1.0};
    homographies_.push_back(HomographyShare(view, points_in_cam1, std::sqrt(2.0) * noise_px, rng));
    clark_evans_.push_back(ClarkEvansIndex(key_points, problem.camera1.width, problem.camera1.height));
  }

  void Give(TwinFit* fit) {
    fit->num_templates = static_cast<int>(num_matches_.size());
    fit->num_matches = static_cast<int>(ComputeMedian(num_matches_));
    double sum = 0.0;
    for (const double share : wrong_shares_) sum += share / static_cast<double>(wrong_shares_.size());
    fit->wrong_share = sum;
    fit->wrong_agreeing_share = ComputeMedian(agreeing_);
    fit->rotation_deg = ComputeMedian(rotations_);
    fit->parallax_deg = ComputeMedian(parallaxes_);
    fit->forwardness = ComputeMedian(forwardness_);
    fit->nearest = ComputeQuantile(depths_, 0.05);
    fit->farthest = ComputeQuantile(depths_, 0.95);
    fit->homography_share = ComputeMedian(homographies_);
    fit->clark_evans = ComputeMedian(clark_evans_);
  }

 private:
  static double AgreeingShare(const std::vector<Correspondence>& wrong) {
    if (wrong.empty()) return 0.0;
    int num_agreeing = 0;
    for (size_t i = 0; i < wrong.size(); ++i) {
      for (size_t k = 0; k < wrong.size(); ++k) {
        const Eigen::Vector2d apart = wrong[k].x1_px - wrong[i].x1_px;
        const Eigen::Vector2d moved_apart = wrong[k].x2_px - wrong[i].x2_px - apart;
        if (k == i || apart.norm() > 30.0 || moved_apart.norm() > 10.0) continue;
        ++num_agreeing;
        break;
      }
    }
    return static_cast<double>(num_agreeing) / static_cast<double>(wrong.size());
  }

  std::vector<double> num_matches_, wrong_shares_, agreeing_, rotations_, parallaxes_, forwardness_, depths_,
      homographies_, clark_evans_;
};

}  // namespace

TwinFit FitTwin(const TwinSource& source, const MotionEstimator& estimator, std::uint64_t seed,
                KeptSteps* steps) {
  TwinFit fit;
  fit.noise = FitNoise(source, estimator, seed, steps);
  RandomStream rng = StreamFor({seed, HashToStreamKey(source.scene), 0, 0}, StreamPurpose::kSeverity);
  LayoutFit layout;
  for (const AnsweredTrial& answered : source.pairs) {
    if (!answered.exact) continue;
    if (fit.camera1.width == 0) {
      fit.camera1 = answered.exact->problem.camera1;
      fit.camera2 = answered.exact->problem.camera2;
    }
    layout.Add(*answered.exact, fit.noise.noise_px, rng);
  }
  if (fit.camera1.width == 0) {
    throw InputError(
        fmt::format("twin: scene {}: none of its {} pairs has a motion with {} matches that agree, by the "
                    "estimator or the "
                    "given truth; there is nothing to resemble",
                    source.scene, source.pairs.size(), kLeastRight));
  }
  if (!(fit.noise.noise_px > 0.0)) fit.noise.noise_px = source.pairs.front().pair.problem.sigma_px;
  fit.simulated_noise = fit.noise;
  layout.Give(&fit);
  return fit;
}

}  // namespace rcme
