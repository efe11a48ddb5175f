#include "estimator/local_optimisation.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "estimator/point_consistency.h"
#include "estimator/reference_matches.h"
#include "estimator/refinement/sampson_mle.h"

namespace rcme {
namespace {

constexpr size_t kGreatestInnerSample = 14;  // the paper's value
constexpr size_t kLeastToFit = 6;            // five matches fit exactly

// `count` of the indices, every set equally likely, ascending.
std::vector<int> DrawSome(std::vector<int> indices, size_t count, RandomStream& rng) {
  for (size_t i = 0; i < count; ++i) {
    const auto rest = static_cast<std::uint32_t>(indices.size() - i);
    std::swap(indices[i], indices[i + rng.IntegerBelow(rest)]);
  }
  indices.resize(count);
  std::ranges::sort(indices);
  return indices;
}

// nullopt if there are too few matches or the fit has no optimum.
std::optional<RefinedMotion> FitTo(const MotionProblem& problem, const std::vector<int>& matches,
                                   const RelativePose& start) {
  if (matches.size() < kLeastToFit) return std::nullopt;
  RefinedMotion motion = RefineBySampson(problem, matches, start, Loss::kSquared);
  if (!motion.converged) return std::nullopt;
  return motion;
}

// The matches within the threshold that the motion's covariance widens.
std::vector<int> FindWithUncertainty(const MotionProblem& problem, const RelativePose& pose,
                                     const Matrix5d& pose_cov, double threshold) {
  const auto model = UncertainFundamental::From(pose, pose_cov, problem.camera1, problem.camera2);
  if (!model) return {};
  std::vector<int> found;
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    const MatchResidual residual = EvaluateResidual(*model, problem.matches[i]);
    const double variance = problem.sigma_px * problem.sigma_px + residual.motion_variance;
    if (residual.squared_distance <= threshold * variance) found.push_back(static_cast<int>(i));
  }
  return found;
}

const Supported& ChooseBetter(const Supported& a, const Supported& b) {
  return b.inliers.size() > a.inliers.size() ? b : a;
}

}  // namespace

Supported WithSupport(const MotionProblem& problem, const RelativePose& pose, double threshold) {
  return {pose, ReferenceMatches(problem, RefinementError::kSampson).FindConsistent(pose, threshold)};
}

Supported OptimiseByInnerRansac(const MotionProblem& problem, const Supported& start, double threshold,
                                const InnerRansac& options, RandomStream& rng) {
  Supported best = start;
  const size_t size = std::min(kGreatestInnerSample, start.inliers.size() / 2);
  if (size < kLeastToFit) return best;
  for (int k = 0; k < options.num_samples; ++k) {
    std::optional<RefinedMotion> motion = FitTo(problem, DrawSome(start.inliers, size, rng), start.pose);
    for (int refit = 1; refit <= options.num_refits && motion; ++refit) {
      const double last = static_cast<double>(refit) / options.num_refits;  // 1 at the end
      const double scale = options.first_threshold + last * (1.0 - options.first_threshold);
      const Supported wide = WithSupport(problem, motion->cam2_from_cam1, scale * scale * threshold);
      motion = FitTo(problem, wide.inliers, motion->cam2_from_cam1);
    }
    if (motion) best = ChooseBetter(best, WithSupport(problem, motion->cam2_from_cam1, threshold));
  }
  return best;
}

Supported OptimiseByUncertainty(const MotionProblem& problem, const Supported& start,
                                const Matrix5d& start_cov, double threshold, int num_refits) {
  RefinedMotion motion{.cam2_from_cam1 = start.pose, .pose_cov = start_cov};
  std::vector<int> fitted;
  for (int refit = 0; refit < num_refits; ++refit) {
    std::vector<int> support =
        FindWithUncertainty(problem, motion.cam2_from_cam1, motion.pose_cov, threshold);
    if (support == fitted) break;
    const std::optional<RefinedMotion> refined = FitTo(problem, support, motion.cam2_from_cam1);
    if (!refined) break;
    motion = *refined;
    fitted = std::move(support);
  }
  return ChooseBetter(start, WithSupport(problem, motion.cam2_from_cam1, threshold));
}

}  // namespace rcme
