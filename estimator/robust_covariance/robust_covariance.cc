#include "estimator/robust_covariance/robust_covariance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "estimator/noise_scale.h"
#include "estimator/refinement/fit_set.h"
#include "estimator/refinement/sampson_equations.h"
#include "estimator/robust_covariance/clustered_covariance.h"
#include "estimator/uncertainty/motion_covariance.h"
#include "stats/order_statistic.h"

namespace rcme {
namespace {

constexpr double kKeyPointRadiusPx = 1.0;
constexpr int kBlocksPerSide = 8, kJackknifeBlocksPerSide = 4;
constexpr double kNormalQuartile = 0.6744897501960817;  // median of |Z|
constexpr size_t kLeastFitted = 6;                      // five matches determine a motion exactly

std::vector<Correspondence> MatchesOf(const MotionProblem& problem, std::span<const int> indices) {
  std::vector<Correspondence> matches;
  for (const int i : indices) matches.push_back(problem.matches[static_cast<size_t>(i)]);
  return matches;
}

// From the median of the residuals' sizes, px.
double SigmaOfResiduals(const MotionProblem& problem, std::span<const int> inliers,
                        const RelativePose& pose) {
  const SampsonLinearization model(problem, pose);
  std::vector<double> sizes;
  for (const int index : inliers) {
    const auto i = static_cast<size_t>(index);
    sizes.push_back(std::abs(model.Evaluate(problem.matches[i], NoiseScaleAt(problem, i)).r));
  }
  return problem.sigma_px * ValueOfRank(sizes.size() / 2, &sizes) / kNormalQuartile;
}

std::vector<int> FittedOf(const MotionProblem& problem, const RelativePose& pose,
                          std::span<const int> inliers) {
  std::vector<int> fitted(inliers.begin(), inliers.end());
  MotionProblem with_own_noise = problem;
  with_own_noise.sigma_px = SigmaOfResiduals(problem, inliers, pose);
  const std::optional<Matrix5d> pose_cov = FirstOrderMotionCovariance(
      pose, problem.camera1, problem.camera2, MatchesOf(problem, inliers), with_own_noise.sigma_px);
  if (!pose_cov) return fitted;
  const std::vector<int> agreeing = SelectFitSet(with_own_noise, {true, pose, *pose_cov, 0}, fitted);
  std::vector<int> both;
  std::ranges::set_union(fitted, agreeing, std::back_inserter(both));
  return both;
}

// How much greater b is than a, on average over the directions, and at least 1.
double EffectOf(const Matrix5d& a, const Matrix5d& b) {
  const double effect = a.llt().solve(b).trace() / 5.0;
  return std::isfinite(effect) ? std::max(1.0, effect) : 1.0;
}

}  // namespace

std::vector<Parameter> Parameters(RobustCovarianceOptions& options) {
  return {Parameter::Real("covariance_factor", &options.factor, {1e-3, 1e3}, "",
                          "of the robust covariance: times this, for errors that reach from block to block"),
          Parameter::Choice<bool>(
              "covariance_jackknife", &options.adds_jackknife, {{"off", false}, {"added", true}},
              "of the robust covariance: the jackknife of 4x4 image blocks on top, conservative")};
}

std::optional<RobustCovarianceParts> RobustParts(const MotionProblem& problem, const RelativePose& pose,
                                                 std::span<const int> inliers) {
  if (inliers.size() < kLeastFitted) return std::nullopt;
  RobustCovarianceParts parts;
  parts.fitted = FittedOf(problem, pose, inliers);
  const std::vector<Correspondence> matches = MatchesOf(problem, parts.fitted);
  const MatchScores scores = ScoreFitted(problem, parts.fitted, pose);
  const auto clustered = [&](const std::vector<int>& groups) { return ClusteredCovariance(scores, groups); };
  parts.own = clustered(KeyPointGroups(matches, kKeyPointRadiusPx));
  parts.inverse_information = scores.information.llt().solve(Matrix5d::Identity());
  if (!parts.own.allFinite() || parts.own.llt().info() != Eigen::Success) return std::nullopt;
  parts.key_point_effect = EffectOf(clustered(Separate(matches.size())), parts.own);
  parts.block_effect = EffectOf(parts.own, clustered(BlockGroups(problem.camera1, matches, kBlocksPerSide)));
  parts.jackknife = clustered(BlockGroups(problem.camera1, matches, kJackknifeBlocksPerSide));
  return parts;
}

std::optional<Matrix5d> RobustCovariance(const MotionProblem& problem, const RelativePose& pose,
                                         std::span<const int> inliers, const RobustCovarianceOptions& options,
                                         const std::optional<Matrix5d>& own_cov) {
  const std::optional<RobustCovarianceParts> parts = RobustParts(problem, pose, inliers);
  if (!parts) return std::nullopt;
  const Matrix5d base = own_cov ? Matrix5d(parts->key_point_effect * *own_cov) : parts->own;
  Matrix5d covariance = options.factor * parts->block_effect * base;
  if (options.adds_jackknife) covariance += parts->jackknife;
  covariance += CalibrationCovariance(
      problem, options.calibration, parts->inverse_information, [&](const MotionProblem& changed) {
        return LinearizeSampson(changed, parts->fitted, pose, Loss::kSquared).gradient;
      });
  return covariance;
}

}  // namespace rcme
