// Box 4 of the paper: refines the winner of the loop over its inlier set.
//
// The code is written once for the two models of MatchSets, which hold a set of matches and sum over it:
// reference_matches.h (one match at a time) and kernels/block_matches.h (many at a time).
#pragma once

#include <algorithm>
#include <concepts>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimator/hypothesis.h"
#include "estimator/motion_estimate.h"
#include "estimator/motion_tests.h"
#include "estimator/ransac_options.h"
#include "estimator/refinement/motion_search.h"
#include "estimator/refinement/rotation_equations.h"

namespace rcme {

// Maximum number of refits after the robust fit; the fit set is nearly always stable after two or three.
inline constexpr int kMaxRefits = 10;

template <typename T>
concept MatchSets = requires(const T matches, const typename T::Set& set, const RelativePose& pose,
                             const RefinedMotion& motion, const EssentialProjection& projection,
                             const std::vector<int>& sorted_indices, const Eigen::Matrix3d& R, Loss loss,
                             const Eigen::Matrix2d& direction_cov, double threshold,
                             double significance_level) {
  { matches.problem() } -> std::same_as<const MotionProblem&>;
  { matches.SelectPose(projection, set) } -> std::same_as<RelativePose>;  // cheirality
  { matches.Refine(set, pose, loss) } -> std::same_as<RefinedMotion>;
  // See refinement/fit_set.h; `set` holds the matches that the motion was fitted to.
  { matches.FindAgreeing(motion, set, significance_level) } -> std::same_as<typename T::Set>;
  { matches.SelectFitSet(motion, set) } -> std::same_as<typename T::Set>;
  // The matches, of all or of a set, with squared Sampson distance over sigma^2 at most the threshold.
  { matches.FindConsistent(pose, threshold) } -> std::same_as<typename T::Set>;
  { matches.CountConsistent(set, pose, threshold) } -> std::same_as<int>;
  // refinement/rotation_equations.h
  { matches.LinearizeRotation(set, R, loss) } -> std::same_as<RotationEquations>;
  { matches.FindRotated(R, threshold) } -> std::same_as<typename T::Set>;
  { matches.BoundRotated(threshold) } -> std::same_as<int>;  // upper bound of the number for any R
  // motion_chance.h, observability.h
  { matches.ChanceOfAgreement(pose, threshold) } -> std::same_as<double>;
  { matches.SumDirectionNoise(set, pose, direction_cov) } -> std::same_as<Eigen::Matrix2d>;
  { matches.MakeSet(sorted_indices) } -> std::convertible_to<typename T::Set>;
  { matches.All() } -> std::convertible_to<typename T::Set>;
  { matches.Intersect(set, set) } -> std::same_as<typename T::Set>;
  { matches.ListIndices(set) } -> std::convertible_to<std::vector<int>>;
  { matches.Count(set) } -> std::same_as<int>;
};

// A motion and the matches it was fitted to.
template <MatchSets Matches>
struct Fit {
  RefinedMotion motion;
  typename Matches::Set fitted;
};

// Decides cheirality again at the optimum. The hypothesis may have been so inaccurate that for the wrong one
// of the four motions of E most matches seemed to lie in front of the cameras. All four have the same E.
template <MatchSets Matches>
RefinedMotion DecideCheiralityAgain(const Matches& matches, const typename Matches::Set& support,
                                    const RefinedMotion& motion) {
  const RelativePose& pose = motion.cam2_from_cam1;
  const RelativePose chosen = matches.SelectPose(ProjectToEssential(EssentialFromPose(pose)), support);
  const bool is_same = chosen.t.dot(pose.t) > 0.0 && RotationAngleBetween(chosen.R, pose.R) < 0.5;
  return is_same ? motion : matches.Refine(support, chosen, Loss::kCauchy);
}

// Fits the motion to the support robustly, then to the matches that agree. It does not converge on five
// matches or fewer: they determine a motion exactly, their residuals and variances are zero, and only
// rounding would decide whether they agree.
template <MatchSets Matches>
Fit<Matches> FitRobustly(const Matches& matches, const typename Matches::Set& support,
                         const RelativePose& start) {
  if (matches.Count(support) <= 5) return {{.cam2_from_cam1 = start}, support};
  Fit<Matches> fit{matches.Refine(support, start, Loss::kCauchy), support};
  if (fit.motion.converged) fit.motion = DecideCheiralityAgain(matches, support, fit.motion);
  for (int refit = 0; refit < kMaxRefits && fit.motion.converged; ++refit) {
    typename Matches::Set selected = matches.SelectFitSet(fit.motion, fit.fitted);
    if (refit > 0 && selected == fit.fitted) break;
    fit.fitted = std::move(selected);
    if (matches.Count(fit.fitted) <= 5) {
      fit.motion.converged = false;
      break;
    }
    fit.motion = matches.Refine(fit.fitted, fit.motion.cam2_from_cam1, Loss::kSquared);
  }
  return fit;
}

template <MatchSets Matches, typename Solver>
Fit<Matches> Refine(const Matches& matches, Refinement refinement, Hypothesis<Solver>* winner,
                    const typename Matches::Set& support) {
  switch (refinement) {
    case Refinement::kMle:
      return {matches.Refine(support, winner->pose, Loss::kSquared), support};
    case Refinement::kRobust:
      return FitRobustly(matches, support, winner->pose);
    case Refinement::kNone:
      break;
  }
  PropagateCovariance(matches.problem(), winner);
  std::vector<int> sample(winner->id.sample.begin(), winner->id.sample.end());
  std::sort(sample.begin(), sample.end());
  return {{true, winner->pose, winner->pose_cov, 0}, matches.MakeSet(sample)};
}

std::string DivergenceMessage(int num_support, int num_fitted);
std::string SuccessMessage(int num_inliers, int num_matches);

// Refines the winner's motion over its inlier set `support`; fills motion, covariance, final inliers, the
// kappa flag and the status. The final inliers are the matches that agree with the refined motion
// (rank-aware, with its covariance). The refinement moves all five degrees of freedom, whatever the minimal
// solver. Without refinement, motion and covariance are the hypothesis's own.
template <MatchSets Matches, typename Solver>
void RefineWinner(const Matches& matches, const RansacOptions& options,
                  const std::optional<Hypothesis<Solver>>& hypothesis, const typename Matches::Set& support,
                  MotionEstimate* estimate) {
  // A nearly degenerate sample: the fast loop found a model, the reference arithmetic does not.
  if (!hypothesis) {
    estimate->status = MotionStatus::kRefinementDiverged;
    estimate->message = "the selected sample is degenerate within rounding error";
    return;
  }
  Hypothesis<Solver> winner = *hypothesis;
  winner.pose = matches.SelectPose(winner.projection, support);
  estimate->initial_pose = winner.pose;
  const Fit<Matches> fit = Refine(matches, options.refinement, &winner, support);
  const RefinedMotion& refined = fit.motion;
  if (!refined.converged) {
    estimate->status = MotionStatus::kRefinementDiverged;
    estimate->message = DivergenceMessage(matches.Count(support), matches.Count(fit.fitted));
    ExplainDivergence(matches, options, winner.pose, support, estimate);
    return;
  }
  estimate->status = MotionStatus::kOk;
  estimate->cam2_from_cam1 = refined.cam2_from_cam1;
  estimate->pose_cov = refined.pose_cov;
  estimate->inliers =
      matches.ListIndices(matches.FindAgreeing(refined, fit.fitted, options.significance_level));
  const double threshold = ConsistencyThreshold(options.significance_level);
  estimate->num_consistent_before = matches.CountConsistent(support, winner.pose, threshold);
  estimate->num_consistent_after = matches.CountConsistent(support, refined.cam2_from_cam1, threshold);
  estimate->num_explained = matches.CountConsistent(matches.All(), refined.cam2_from_cam1, threshold);
  estimate->failed_by_kappa =
      estimate->num_consistent_after <= options.kappa * estimate->num_consistent_before;  // (eq::metric)
  estimate->message = SuccessMessage(static_cast<int>(estimate->inliers.size()),
                                     static_cast<int>(matches.problem().matches.size()));
  RefuseByMotionTests(matches, options, estimate);
}

}  // namespace rcme
