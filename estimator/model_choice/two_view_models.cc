#include "estimator/model_choice/two_view_models.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "estimator/estimators/standard.h"
#include "estimator/geometry/sampson.h"
#include "estimator/model_choice/homography.h"
#include "estimator/reference_matches.h"
#include "estimator/refinement/rotation_mle.h"
#include "estimator/solvers/solver_list.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// With 60 % wrong matches a sample of two is free of outliers with probability 0.16, of four with 0.026, of
// five with 0.010. All samples contain outliers with probability 3e-8, 4e-4 and 0.05.
constexpr int kRotationSamples = 100, kHomographySamples = 300, kEssentialSamples = 300;

// Number of motions refined. The refinement of only the best one may drop the near half of a scene for its
// leverage and keep far points, which any direction explains.
constexpr int kRefinedMotions = 5;

// Significance level for the matches that a model is fitted to and that a sample is scored by.
constexpr double kFitLevel = 0.001;

double TransferThreshold() { return ChiSquareQuantile(2, 1.0 - kFitLevel); }

// The best of `start` and the models of random samples.
template <size_t size, typename Solve>
Eigen::Matrix3d BestOfSamples(const RayMatches& all, int num_samples, const Eigen::Matrix3d& start,
                              Solve solve, RandomStream& rng) {
  const double threshold = TransferThreshold();
  Eigen::Matrix3d best = start;
  double least = TruncatedCost(all, start, threshold, std::numeric_limits<double>::infinity());
  for (int k = 0; k < num_samples; ++k) {
    const Sample indices = DrawSample(static_cast<int>(size), static_cast<int>(all.matches.size()), rng);
    std::array<RayMatch, size> sample;
    for (size_t i = 0; i < size; ++i) sample[i] = all.matches[static_cast<size_t>(indices[i])];
    const std::optional<Eigen::Matrix3d> model = solve(sample);
    if (!model) continue;
    const double cost = TruncatedCost(all, *model, threshold, least);
    if (cost >= least) continue;
    least = cost;
    best = *model;
  }
  return best;
}

Eigen::Matrix3d FitRotationTo(const MotionProblem& problem, const RayMatches& all, RandomStream& rng) {
  const double threshold = TransferThreshold();
  const Eigen::Matrix3d start =
      BestOfSamples<2>(all, kRotationSamples, Eigen::Matrix3d::Identity(), RotationOfTwo, rng);
  const ReferenceMatches matches(problem, RefinementError::kSampson);
  const Eigen::Matrix3d R =
      rcme::FitRotation(matches, matches.FindRotated(start, threshold), start, threshold).R;
  const double cost = TruncatedCost(all, start, threshold, std::numeric_limits<double>::infinity());
  return TruncatedCost(all, R, threshold, cost) <= cost ? R : start;
}

std::vector<double> SquaredSampsonDistances(const MotionProblem& problem, const Eigen::Matrix3d& E) {
  const Eigen::Matrix3d F = FundamentalFromEssential(E, problem.camera1, problem.camera2);
  const double variance = problem.sigma_px * problem.sigma_px;
  std::vector<double> squared;
  squared.reserve(problem.matches.size());
  for (const Correspondence& match : problem.matches) {
    const double e2 = SquaredSampsonDistance(F, match) / variance;
    squared.push_back(e2 >= 0.0 ? e2 : 0.0);  // 0 / 0 if both points are epipoles
  }
  return squared;
}

double TruncatedSum(const std::vector<double>& squared, double threshold) {
  double sum = 0.0;
  for (const double e2 : squared) sum += std::min(e2, threshold);
  return sum;
}

// The motion with the least truncated sum: the one that `standard` finds from samples of five and refines, or
// the rotation with a direction along one of the axes.
void FitEssential(const MotionProblem& problem, RandomStream& rng, TwoViewFits* fits) {
  RansacOptions options;
  options.solver = MinimalSolver::kFivePoint;
  options.num_iterations = kEssentialSamples;
  options.num_refined = kRefinedMotions;
  const MotionEstimate found = MakeStandard(options)->Estimate(problem, rng);
  std::vector<RelativePose> poses;
  if (found.status == MotionStatus::kOk) poses.push_back(found.cam2_from_cam1);
  for (int axis = 0; axis < 3; ++axis) poses.push_back({fits->rotation.matrix, Eigen::Vector3d::Unit(axis)});
  const double threshold = ChiSquareQuantile(1, 1.0 - kFitLevel);
  double least = std::numeric_limits<double>::infinity();
  for (const RelativePose& pose : poses) {
    ModelFit fit{EssentialFromPose(pose), {}};
    fit.squared_residuals = SquaredSampsonDistances(problem, fit.matrix);
    const double sum = TruncatedSum(fit.squared_residuals, threshold);
    if (sum >= least) continue;
    least = sum;
    fits->essential = std::move(fit);
    fits->motion = pose;
  }
}

}  // namespace

const ModelDimensions& FindDimensions(TwoViewModel model) {
  switch (model) {
    case TwoViewModel::kRotation:
      return kRotationDimensions;
    case TwoViewModel::kHomography:
      return kHomographyDimensions;
    case TwoViewModel::kEssential:
      break;
  }
  return kEssentialDimensions;
}

const ModelFit& TwoViewFits::operator[](TwoViewModel model) const {
  switch (model) {
    case TwoViewModel::kRotation:
      return rotation;
    case TwoViewModel::kHomography:
      return homography;
    case TwoViewModel::kEssential:
      break;
  }
  return essential;
}

TwoViewFits FitTwoViewModels(const MotionProblem& problem, RandomStream& rng) {
  const RayMatches all(problem);
  const Eigen::Matrix3d R = FitRotationTo(problem, all, rng);
  const Eigen::Matrix3d sampled = BestOfSamples<4>(all, kHomographySamples, R, HomographyOfFour, rng);
  const Eigen::Matrix3d H = RefineHomography(all, sampled, TransferThreshold());
  TwoViewFits fits{.rotation = {R, SquaredTransfers(all, R)},
                   .homography = {H, SquaredTransfers(all, H)},
                   .essential = {},
                   .motion = {}};
  FitEssential(problem, rng, &fits);
  return fits;
}

std::vector<int> FindInliers(const ModelFit& fit, TwoViewModel model, double significance_level) {
  const double threshold = ChiSquareQuantile(FindDimensions(model).codimension(), 1.0 - significance_level);
  std::vector<int> inliers;
  for (int i = 0; i < static_cast<int>(fit.squared_residuals.size()); ++i) {
    if (fit.squared_residuals[static_cast<size_t>(i)] <= threshold) inliers.push_back(i);
  }
  return inliers;
}

}  // namespace rcme
