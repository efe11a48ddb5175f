#include "estimator/calibrated/settle_direction.h"

#include <cmath>

#include "estimator/calibrated/weigh_modes.h"

namespace rcme {
namespace {

constexpr double kLowParallax = 6.0, kSettled = 0.8;
constexpr int kDirectionSteps = 15;

// The mode at the optimum reached from the most likely direction; nullopt if it explains no more than five
// matches, which any motion through them explains.
std::optional<ExplainedMode> MovedTo(const MatchBlocks& matches, const MixturePrior& prior, Mode mode) {
  if (!FitMode(matches, prior, kDirectionSteps, &mode)) return std::nullopt;
  ExplainedMode moved{mode, Explain(matches, mode)};
  if (moved.explanation.num_explained <= 5) return std::nullopt;
  return moved;
}

// If the answer stays though the law prefers another direction: the odds of the modes divide the mass of
// both.
WeakDirection DivideMass(const DirectionPosterior& found, double log_odds) {
  const double share = 1.0 / (1.0 + std::exp(-log_odds));
  return {std::max(found.mass_within, share * found.mass_of_both), found.covariance};
}

}  // namespace

std::optional<WeakDirection> SettleDirection(const MotionProblem& problem, const MatchBlocks& matches,
                                             const MixturePrior& prior, double angle_rad,
                                             CalibratedStep leave_out, ExplainedMode* answer) {
  if (UsualDepthInNoise(answer->explanation) > kLowParallax) return std::nullopt;
  if (problem.prior && problem.prior->direction && problem.prior->direction->sd_rad < 0.5 * angle_rad)
    return std::nullopt;
  const DirectionPosterior found = PosteriorOfDirection(problem, *answer, answer->mode.pose.t, angle_rad);
  const WeakDirection direction{found.mass_within, found.covariance};
  if (found.mass_within > kSettled) return direction;
  std::optional<ExplainedMode> moved = MovedTo(matches, prior, found.best);
  if (!moved) return direction;
  const double log_odds = ComputeLogOdds(*answer, *moved, prior, leave_out);
  const bool is_far = AngleBetween(moved->mode.pose.t, answer->mode.pose.t) > angle_rad;
  if (log_odds > 0.0) return is_far ? DivideMass(found, log_odds) : direction;
  const DirectionPosterior of_moved = PosteriorOfDirection(problem, *moved, moved->mode.pose.t, angle_rad);
  if (of_moved.mass_within <= found.mass_within) return direction;
  *answer = std::move(*moved);
  return WeakDirection{of_moved.mass_within, of_moved.covariance};
}

}  // namespace rcme
