#include "stats/splitting_rate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/lognormal_mean.h"
#include "stats/moments.h"

namespace rcme {
namespace {

// The least over the levels of the acceptance averaged over the replicates that reached the level.
double LeastAcceptance(const std::vector<SplittingReplicate>& replicates) {
  std::vector<Moments> levels;
  for (const SplittingReplicate& replicate : replicates) {
    levels.resize(std::max(levels.size(), replicate.acceptance.size()));
    for (size_t k = 0; k < replicate.acceptance.size(); ++k) levels[k].Add(replicate.acceptance[k]);
  }
  double least = 1.0;
  for (const Moments& level : levels) least = std::min(least, level.mean());
  return least;
}

}  // namespace

std::string Name(SplittingDoubt doubt) {
  switch (doubt) {
    case SplittingDoubt::kNoLevels:
      return "no_levels";
    case SplittingDoubt::kReplicateLost:
      return "replicate_lost";
    case SplittingDoubt::kReplicatesDisagree:
      return "replicates_disagree";
    case SplittingDoubt::kDrawsDisagree:
      return "draws_disagree";
    case SplittingDoubt::kMovesStuck:
      return "moves_stuck";
  }
  return "";
}

SplittingRate EstimateSplittingRate(const SplittingPilot& pilot,
                                    const std::vector<SplittingReplicate>& replicates) {
  SplittingRate rate;
  rate.num_values = pilot.num_values;
  if (pilot.end != PilotEnd::kReached) {
    rate.estimate = rate.standard_error = rate.relative_spread = std::numeric_limits<double>::quiet_NaN();
    rate.interval = {0.0, 1.0};
    rate.doubts = {SplittingDoubt::kNoLevels};
    return rate;
  }
  Moments estimates, logarithms;
  std::int64_t num_drawn = 0, num_drawn_events = 0;
  for (const SplittingReplicate& replicate : replicates) {
    estimates.Add(replicate.estimate);
    if (replicate.estimate > 0.0) logarithms.Add(std::log(replicate.estimate));
    num_drawn += replicate.num_drawn;
    num_drawn_events += replicate.num_drawn_events;
    rate.num_values += replicate.num_values;
  }
  rate.estimate = estimates.mean();
  rate.standard_error = estimates.standard_error();
  rate.relative_spread = rate.estimate > 0.0 ? std::sqrt(estimates.variance()) / rate.estimate : 0.0;
  rate.least_acceptance = LeastAcceptance(replicates);
  rate.unseen_up_to = ExactBinomialInterval(num_drawn_events, num_drawn).upper;
  const bool is_lost = logarithms.n() < estimates.n();
  // Without levels the replicates are shares of initial particles, which scatter less than the logarithms can
  // show if all or nearly all are events.
  const bool has_levels = std::ranges::any_of(
      replicates, [](const SplittingReplicate& replicate) { return !replicate.acceptance.empty(); });
  rate.interval = is_lost       ? Interval{0.0, 1.0}
                  : !has_levels ? ExactBinomialInterval(num_drawn_events, num_drawn)
                                : LognormalMeanInterval(logarithms);
  rate.interval.upper = std::min(1.0, rate.interval.upper);
  const Interval drawn = ExactBinomialInterval(num_drawn_events, num_drawn, 1.0 - kDrawsSignificanceLevel);
  if (is_lost) rate.doubts.push_back(SplittingDoubt::kReplicateLost);
  if (rate.relative_spread > kMaxRelativeSpread) rate.doubts.push_back(SplittingDoubt::kReplicatesDisagree);
  if (drawn.lower > rate.interval.upper || drawn.upper < rate.interval.lower)
    rate.doubts.push_back(SplittingDoubt::kDrawsDisagree);
  if (rate.least_acceptance < kMinAcceptance) rate.doubts.push_back(SplittingDoubt::kMovesStuck);
  return rate;
}

}  // namespace rcme
