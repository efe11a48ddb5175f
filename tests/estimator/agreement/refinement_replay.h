// The refinement of both implementations, set by set: where they part, and how far from a tie.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "estimator/geometry/triangulation.h"
#include "estimator/kernels/block_matches.h"
#include "estimator/reference_matches.h"
#include "estimator/refine_winner.h"
#include "stats/distributions.h"
#include "tests/estimator/agreement/loop_replay.h"

namespace rcme::agreement {

// How far a match is from changing sides in the fit set or in the final inliers: the least distance of its
// squared residual from its bound (over that of sigma^2 alone: a fit to five matches leaves both at zero),
// and of its leverage, its parallax and its depths from theirs.
inline double DistanceFromTie(const MotionProblem& problem, const RefinedMotion& motion,
                              const Correspondence& match, bool is_fitted, double significance_level,
                              double max_leverage) {
  const auto model =
      UncertainFundamental::From(motion.cam2_from_cam1, motion.pose_cov, problem.camera1, problem.camera2);
  const MatchResidual residual = EvaluateResidual(model.value(), match);
  const double sigma2 = problem.sigma_px * problem.sigma_px;
  const double variance = sigma2 + (is_fitted ? -1.0 : 1.0) * residual.motion_variance;
  const double threshold = ChiSquareQuantile(1, 1.0 - significance_level);
  const Eigen::Vector3d ray1 = motion.cam2_from_cam1.R * problem.camera1.Ray(match.x1_px);
  const double parallax_px = (problem.camera2.Project(ray1) - match.x2_px).norm();
  const double inverse_depth =
      InverseDepth(motion.cam2_from_cam1, problem.camera1.Ray(match.x1_px), problem.camera2.Ray(match.x2_px));
  return std::min({std::abs(residual.squared_distance - threshold * variance) / (threshold * sigma2),
                   std::abs(residual.motion_variance / (max_leverage * sigma2) - 1.0),
                   std::abs(parallax_px / (6.0 * problem.sigma_px) - 1.0), std::abs(inverse_depth),
                   std::abs((ray1 + inverse_depth * motion.cam2_from_cam1.t).z())});
}

inline constexpr const char* kCheiralityTie = "tie of the cheirality";

// Follows FitRobustly in both implementations from the same support: as long as the sets agree, the motions
// are the same to rounding, so that the first sets that differ are the cause.
class RefinementReplay {
 public:
  explicit RefinementReplay(const MotionProblem& problem)
      : problem_(problem),
        matches_(problem),
        fast_(problem, matches_, RefinementError::kSampson),
        reference_(problem, RefinementError::kSampson) {}

  std::optional<Cause> FindCause(const MatchMask& support, const RelativePose& fast_start,
                                 const RelativePose& reference_start) const {
    std::vector<int> fitted = ListIndices(support);
    Motions motions = Refine(fitted, {fast_start, reference_start}, Loss::kCauchy);
    if (!motions.AreSame()) return Cause{"robust fit", std::nan("")};
    if (motions.fast.converged) {
      motions = {DecideCheiralityAgain(fast_, support, motions.fast),
                 DecideCheiralityAgain(reference_, fitted, motions.reference)};
      if (!motions.AreSame()) return CheiralityCause(fitted, motions);
    }
    for (int refit = 0; refit < kMaxRefits && motions.fast.converged; ++refit) {
      const std::vector<int> selected = reference_.SelectFitSet(motions.reference, fitted);
      const double max_leverage = MaxLeverage(static_cast<int>(fitted.size()));
      const std::vector<int> in_fast = ListIndices(fast_.SelectFitSet(motions.fast, fast_.MakeSet(fitted)));
      if (auto cause = Compare("fit set", motions.reference, fitted, kFitSignificance, max_leverage, in_fast,
                               selected)) {
        return cause;
      }
      if (refit > 0 && selected == fitted) break;
      fitted = selected;
      if (fitted.size() <= 5) return std::nullopt;
      motions =
          Refine(fitted, {motions.fast.cam2_from_cam1, motions.reference.cam2_from_cam1}, Loss::kSquared);
      if (!motions.AreSame()) return Cause{"refit", std::nan("")};
    }
    if (!motions.fast.converged) return std::nullopt;
    const double alpha = RansacOptions().significance_level;
    return Compare("final inlier", motions.reference, fitted, alpha, std::numeric_limits<double>::infinity(),
                   ListIndices(fast_.FindAgreeing(motions.fast, fast_.MakeSet(fitted), alpha)),
                   reference_.FindAgreeing(motions.reference, fitted, alpha));
  }

 private:
  struct Motions {
    RefinedMotion fast, reference;
    bool AreSame() const {
      return fast.converged == reference.converged &&
             LocalCoordinates(fast.cam2_from_cam1, reference.cam2_from_cam1).norm() < 1e-9;
    }
  };
  struct Starts {
    RelativePose fast, reference;
  };
  Motions Refine(const std::vector<int>& fitted, const Starts& starts, Loss loss) const {
    return {fast_.Refine(fast_.MakeSet(fitted), starts.fast, loss),
            reference_.Refine(fitted, starts.reference, loss)};
  }

  // Of the four motions of E two may have as many matches in front of the cameras. The first is taken, and
  // which is first depends on the signs of a singular value decomposition.
  Cause CheiralityCause(const std::vector<int>& support, const Motions& motions) const {
    const auto count = [&](const RelativePose& pose) {
      return std::ranges::count_if(support, [&](int i) {
        const Correspondence& match = problem_.matches[static_cast<size_t>(i)];
        return IsInFrontOfBothCameras(pose, problem_.camera1.Ray(match.x1_px),
                                      problem_.camera2.Ray(match.x2_px));
      });
    };
    const bool is_tie = count(motions.fast.cam2_from_cam1) == count(motions.reference.cam2_from_cam1);
    return {is_tie ? kCheiralityTie : "cheirality", is_tie ? 0.0 : std::nan("")};
  }

  std::optional<Cause> Compare(const std::string& kind, const RefinedMotion& motion,
                               const std::vector<int>& fitted, double significance_level, double max_leverage,
                               const std::vector<int>& a, const std::vector<int>& b) const {
    std::vector<int> differing;
    std::ranges::set_symmetric_difference(a, b, std::back_inserter(differing));
    std::optional<Cause> cause;
    for (const int i : differing) {
      const bool is_fitted = std::ranges::binary_search(fitted, i);
      KeepGreater(kind,
                  DistanceFromTie(problem_, motion, problem_.matches[static_cast<size_t>(i)], is_fitted,
                                  significance_level, max_leverage),
                  &cause);
    }
    return cause;
  }

  const MotionProblem& problem_;
  MatchBlocks matches_;
  BlockMatches fast_;
  ReferenceMatches reference_;
};

}  // namespace rcme::agreement
