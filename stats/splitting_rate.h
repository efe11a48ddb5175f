// The rate of an event from independent replicates of multilevel splitting, and whether it can be trusted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "stats/intervals.h"
#include "stats/splitting.h"

namespace rcme {

// Reasons to distrust an interval.
enum class SplittingDoubt {
  kNoLevels,            // the pilot did not reach the event: there is no estimate
  kReplicateLost,       // a replicate lost all its particles on the way
  kReplicatesDisagree,  // relative standard deviation above kMaxRelativeSpread: few replicates have most of
                        // the rate
  kDrawsDisagree,       // the number of events among the initial particles (plain Monte Carlo) contradicts
                        // the interval
  kMovesStuck,          // at some level fewer than kMinAcceptance of the local moves were accepted
};
std::string Name(SplittingDoubt doubt);  // "no_levels", ...

// Above it the law of the replicates has a tail that so few replicates do not show.
inline constexpr double kMaxRelativeSpread = 1.0;
inline constexpr double kMinAcceptance = 0.05;
// Two-sided significance level of the test for kDrawsDisagree.
inline constexpr double kDrawsSignificanceLevel = 1e-3;

struct SplittingRate {
  double estimate = 0.0;  // mean of the replicates: unbiased; NaN without levels
  double standard_error = 0.0;
  double relative_spread = 0.0;  // standard deviation of the replicates over their mean
  // 95 % (stats/lognormal_mean.h), without levels the exact one of the initial particles; [0, 1] if
  // undefined.
  Interval interval;
  // The upper end of the exact 95 % interval from the initial particles alone. Failures of a kind to which no
  // level leads may have any rate up to this and be missed.
  double unseen_up_to = 1.0;
  std::int64_t num_values = 0;  // values computed, including the pilot's
  double least_acceptance = 1.0;
  std::vector<SplittingDoubt> doubts;

  bool IsTrusted() const { return doubts.empty(); }
};

// Takes at least two replicates; none if the pilot found no levels.
SplittingRate EstimateSplittingRate(const SplittingPilot& pilot,
                                    const std::vector<SplittingReplicate>& replicates);

}  // namespace rcme
