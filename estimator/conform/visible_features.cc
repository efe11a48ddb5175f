#include "estimator/conform/visible_features.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/sampson.h"
#include "estimator/model_choice/homography.h"
#include "estimator/motion_tests.h"
#include "estimator/noise_scale.h"
#include "estimator/sample.h"
#include "stats/constants.h"
#include "stats/forecast.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

constexpr double kAgreementLevel = 0.05;
constexpr double kLeastRatio = 1e-3;  // least argument of a logarithm
constexpr size_t kMostForPlane = 200;
// of four matches: with probability .72 one lies on a plane of half the matches
constexpr int kPlaneSamples = 20;

double LogOdds(double yes, double no) { return std::log((yes + 1.0) / (no + 1.0)); }

std::vector<int> FindAgreeing(const MotionProblem& problem, const Eigen::Matrix3d& F) {
  const double threshold = ConsistencyThreshold(kAgreementLevel) * problem.sigma_px * problem.sigma_px;
  std::vector<int> agreeing;
  for (size_t i = 0; i < problem.matches.size(); ++i)
    if (SquaredSampsonDistance(F, problem.matches[i]) <= threshold) agreeing.push_back(static_cast<int>(i));
  return agreeing;
}

double ResidualScale(const MotionProblem& problem, const Eigen::Matrix3d& F,
                     const std::vector<int>& inliers) {
  constexpr double kMedianOfNormal = 0.6745;  // of |x|
  std::vector<double> distances;
  for (const int i : inliers) {
    const Correspondence& match = problem.matches[static_cast<size_t>(i)];
    distances.push_back(std::sqrt(SquaredSampsonDistance(F, match)));
  }
  return ComputeMedian(std::move(distances)) / (kMedianOfNormal * problem.sigma_px);
}

// |x2 - h(x1)| of the rotation's homography, over sqrt(2) sigma; infinite behind camera 2.
double MedianParallax(const std::vector<RayMatch>& matches, const RayScale& noise, const Eigen::Matrix3d& R) {
  std::vector<double> parallax;
  for (const RayMatch& match : matches) {
    const Eigen::Vector3d turned = R * match.ray1;
    if (!(turned.z() > 0.0)) {
      parallax.push_back(kInfinity);
      continue;
    }
    const double x = (match.ray2.x() - turned.x() / turned.z()) / noise.x2;
    const double y = (match.ray2.y() - turned.y() / turned.z()) / noise.y2;
    parallax.push_back(std::hypot(x, y) / std::sqrt(2.0));
  }
  return ComputeMedian(std::move(parallax));
}

// The number of matches on a plane: those that the best homography of a few samples explains, after
// refinement.
int CountOnPlane(const RayMatches& all) {
  const double threshold = ConsistencyThreshold(kAgreementLevel);
  RandomStream rng({.seed = 1, .condition = 0, .trial = 0, .purpose = 1});  // the same samples for all
  std::optional<Eigen::Matrix3d> best;
  double least = kInfinity;
  for (int k = 0; k < kPlaneSamples; ++k) {
    const Sample indices = DrawSample(4, static_cast<int>(all.matches.size()), rng);
    FourMatches sample;
    for (size_t i = 0; i < sample.size(); ++i) sample[i] = all.matches[static_cast<size_t>(indices[i])];
    const std::optional<Eigen::Matrix3d> H = HomographyOfFour(sample);
    if (!H) continue;
    const double cost = TruncatedCost(all, *H, threshold, least);
    if (cost >= least) continue;
    least = cost;
    best = *H;
  }
  if (!best) return 0;
  const std::vector<double> d2 = SquaredTransfers(all, RefineHomography(all, *best, threshold));
  return static_cast<int>(std::ranges::count_if(d2, [&](double x) { return x <= threshold; }));
}

double Spread(const RayMatches& all) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const RayMatch& match : all.matches) mean += match.ray1.head<2>();
  mean /= static_cast<double>(all.matches.size());
  double sum = 0.0;
  for (const RayMatch& match : all.matches) sum += (match.ray1.head<2>() - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(all.matches.size()));
}

bool IsFinite(const MotionEstimate& estimate, size_t num_matches) {
  const bool are_matches = std::ranges::all_of(
      estimate.inliers, [&](int i) { return i >= 0 && i < static_cast<int>(num_matches); });
  return estimate.status == MotionStatus::kOk && estimate.cam2_from_cam1.R.allFinite() &&
         estimate.cam2_from_cam1.t.allFinite() && estimate.pose_cov.allFinite() && are_matches;
}

double LogRatio(double x) { return std::log(std::clamp(x, kLeastRatio, 1.0 / kLeastRatio / kLeastRatio)); }

}  // namespace

const std::vector<std::string>& VisibleFeatureNames() {
  static const std::vector<std::string> names = {"matches",  "agreeing",    "agreeing_share", "residual",
                                                 "parallax", "planarity",   "spread",         "rotation",
                                                 "axial",    "rotation_sd", "direction_sd",   "stated_odds"};
  return names;
}

VisibleFeatures MeasureVisibleFeatures(const MotionProblem& problem, const MotionEstimate& estimate) {
  VisibleFeatures features;
  features.fill(kNaN);
  const auto set = [&](VisibleFeature feature, double value) {
    features[static_cast<size_t>(feature)] = std::isfinite(value) ? value : kNaN;
  };
  const size_t n = problem.matches.size();
  set(VisibleFeature::kMatches, std::log1p(static_cast<double>(n)));
  if (!IsFinite(estimate, n)) return features;

  const RelativePose& pose = estimate.cam2_from_cam1;
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2);
  const std::vector<int> agreeing = FindAgreeing(problem, F);
  const auto num_agreeing = static_cast<double>(agreeing.size());
  set(VisibleFeature::kAgreeing, std::log1p(num_agreeing));
  set(VisibleFeature::kAgreeingShare, LogOdds(num_agreeing, static_cast<double>(n) - num_agreeing));
  set(VisibleFeature::kResidual, LogRatio(ResidualScale(problem, F, estimate.inliers)));

  const RayMatches all(SelectPart(problem, agreeing));
  set(VisibleFeature::kParallax, LogRatio(MedianParallax(all.matches, all.noise, pose.R)));
  if (agreeing.size() >= 4) {
    RayMatches some = all;
    some.matches.resize(std::min(some.matches.size(), kMostForPlane));
    const int on_plane = CountOnPlane(some);
    set(VisibleFeature::kPlanarity, LogOdds(on_plane, static_cast<double>(some.matches.size()) - on_plane));
    set(VisibleFeature::kSpread, LogRatio(Spread(all)));
  }
  set(VisibleFeature::kRotation,
      std::log(0.1 + kDegPerRad * RotationAngleBetween(pose.R, Eigen::Matrix3d::Identity())));
  set(VisibleFeature::kAxialShare, std::abs(pose.t.z()));
  set(VisibleFeature::kRotationSd, 0.5 * std::log(estimate.pose_cov.topLeftCorner<3, 3>().trace()));
  set(VisibleFeature::kDirectionSd, 0.5 * std::log(estimate.pose_cov.bottomRightCorner<2, 2>().trace()));
  if (estimate.failure_probability >= 0.0 && estimate.failure_probability <= 1.0) {
    const double p = ClippedProbability(estimate.failure_probability);
    set(VisibleFeature::kStatedOdds, std::log(p / (1.0 - p)));
  }
  return features;
}

}  // namespace rcme
