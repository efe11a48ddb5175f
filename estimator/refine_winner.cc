#include "estimator/refine_winner.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "estimator/geometry/sampson.h"
#include "estimator/ransac_loop.h"
#include "estimator/refinement/reprojection_mle.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// The robust refinement's last fit takes every match within this quantile: wide enough to leave the Gaussian
// tails in (cutting at 95 % would shrink the reported covariance to 0.76 of the true one, at 99.9 % to 0.99).
constexpr double kRefitSignificance = 0.001;

Eigen::Matrix3d FundamentalOf(const MotionProblem& problem, const RelativePose& pose) {
  return FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2);
}

// Most refits after the robust fit; the agreeing set is nearly always stable after two or three.
constexpr int kMaxRefits = 10;

RefinedMotion RefineRobustly(const MotionProblem& problem, const std::vector<int>& support,
                             const RelativePose& start) {
  RefinedMotion motion = RefineByReprojection(problem, support, start, Loss::kCauchy);
  const double threshold = ChiSquareQuantile(1, 1.0 - kRefitSignificance);
  std::vector<int> fitted;
  for (int refit = 0; refit < kMaxRefits && motion.converged; ++refit) {
    const KnownPoseTest test(FundamentalOf(problem, motion.cam2_from_cam1), problem.sigma_px);
    std::vector<int> agreeing = FindInliers(problem, test, threshold);
    if (agreeing == fitted) break;
    fitted = std::move(agreeing);
    motion = RefineByReprojection(problem, fitted, motion.cam2_from_cam1, Loss::kSquared);
  }
  return motion;
}

RefinedMotion Refine(const MotionProblem& problem, const RansacOptions& options, const Hypothesis& winner,
                     const std::vector<int>& support) {
  switch (options.refinement) {
    case Refinement::kMle:
      return RefineByReprojection(problem, support, winner.pose, Loss::kSquared);
    case Refinement::kRobust:
      return RefineRobustly(problem, support, winner.pose);
    case Refinement::kNone:
      break;
  }
  return {true, winner.pose, winner.pose_cov, 0};
}

// Inliers of the refined motion, its own uncertainty included.
std::vector<int> FinalInliers(const MotionProblem& problem, const RefinedMotion& motion,
                              double significance_level) {
  const auto model =
      UncertainFundamental::From(motion.cam2_from_cam1, motion.pose_cov, problem.camera1, problem.camera2);
  if (!model) return {};
  return FindInliers(problem, RankAwareTest(*model, problem.sigma_px),
                     ChiSquareQuantile(1, 1.0 - significance_level));
}

}  // namespace

int CountConsistent(const MotionProblem& problem, const std::vector<int>& indices, const RelativePose& pose,
                    double significance_level) {
  const Eigen::Matrix3d F = FundamentalOf(problem, pose);
  const double threshold =
      problem.sigma_px * problem.sigma_px * ChiSquareQuantile(2, 1.0 - significance_level);
  return static_cast<int>(std::count_if(indices.begin(), indices.end(), [&](int index) {
    return SquaredSampsonDistance(F, problem.matches[static_cast<size_t>(index)]) < threshold;
  }));
}

void RefineWinner(const MotionProblem& problem, const RansacOptions& options, const Hypothesis& winner,
                  const std::vector<int>& support, MotionEstimate* estimate) {
  estimate->initial_pose = winner.pose;
  const RefinedMotion refined = Refine(problem, options, winner, support);
  if (!refined.converged) {
    estimate->status = MotionStatus::kRefinementDiverged;
    estimate->message = fmt::format("the refinement over {} matches found no finite optimum", support.size());
    return;
  }
  estimate->status = MotionStatus::kOk;
  estimate->cam2_from_cam1 = refined.cam2_from_cam1;
  estimate->pose_cov = refined.pose_cov;
  estimate->inliers = FinalInliers(problem, refined, options.significance_level);
  estimate->num_consistent_before =
      CountConsistent(problem, support, winner.pose, options.significance_level);
  estimate->num_consistent_after =
      CountConsistent(problem, support, refined.cam2_from_cam1, options.significance_level);
  estimate->failed_by_kappa =
      estimate->num_consistent_after <= options.kappa * estimate->num_consistent_before;  // (eq::metric)
  estimate->message =
      fmt::format("motion from {} of {} matches", estimate->inliers.size(), problem.matches.size());
}

}  // namespace rcme
