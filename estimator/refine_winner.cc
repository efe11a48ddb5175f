#include "estimator/refine_winner.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimator/geometry/sampson.h"
#include "estimator/refinement/fit_set.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// Most refits after the robust fit; the fit set is nearly always stable after two or three.
constexpr int kMaxRefits = 10;

Eigen::Matrix3d FundamentalOf(const MotionProblem& problem, const RelativePose& pose) {
  return FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2);
}

// A motion and the matches it was fitted to.
struct Fit {
  RefinedMotion motion;
  std::vector<int> fitted;
};

Fit FitRobustly(const MotionProblem& problem, const std::vector<int>& support, const RelativePose& start) {
  Fit fit{RefineByReprojection(problem, support, start, Loss::kCauchy), support};
  for (int refit = 0; refit < kMaxRefits && fit.motion.converged; ++refit) {
    std::vector<int> selected = SelectFitSet(problem, fit.motion, fit.fitted);
    if (refit > 0 && selected == fit.fitted) break;
    fit.fitted = std::move(selected);
    fit.motion = RefineByReprojection(problem, fit.fitted, fit.motion.cam2_from_cam1, Loss::kSquared);
  }
  return fit;
}

Fit Refine(const MotionProblem& problem, const RansacOptions& options, const Hypothesis& winner,
           const std::vector<int>& support) {
  switch (options.refinement) {
    case Refinement::kMle:
      return {RefineByReprojection(problem, support, winner.pose, Loss::kSquared), support};
    case Refinement::kRobust:
      return FitRobustly(problem, support, winner.pose);
    case Refinement::kNone:
      break;
  }
  std::vector<int> sample(winner.sample.begin(), winner.sample.end());
  std::sort(sample.begin(), sample.end());
  return {{true, winner.pose, winner.pose_cov, 0}, sample};
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
  const Fit fit = Refine(problem, options, winner, support);
  const RefinedMotion& refined = fit.motion;
  if (!refined.converged) {
    estimate->status = MotionStatus::kRefinementDiverged;
    estimate->message =
        fmt::format("the refinement, begun with {} matches, was left with {} and no finite optimum",
                    support.size(), fit.fitted.size());
    return;
  }
  estimate->status = MotionStatus::kOk;
  estimate->cam2_from_cam1 = refined.cam2_from_cam1;
  estimate->pose_cov = refined.pose_cov;
  estimate->inliers = FindAgreeing(problem, refined, fit.fitted, options.significance_level);
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
