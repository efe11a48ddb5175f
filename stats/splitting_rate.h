// The rate of an event from independent replicates of multilevel splitting, and whether it can be trusted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "stats/intervals.h"
#include "stats/splitting.h"

namespace rcme {

// Why an interval may not be believed.
enum class SplittingDoubt {
  kNoLevels,            // the pilot did not reach the event: there is no estimate
  kReplicateLost,       // a replicate lost all its particles on the way
  kReplicatesDisagree,  // their relative standard deviation is beyond kMaxRelativeSpread: a few hold most of
                        // the rate
  kDrawsDisagree,  // the first particles, brute force as it were, hold more or fewer events than the interval
                   // allows
  kMovesStuck,     // at some level fewer than kMinAcceptance of the local moves were accepted
};
std::string Name(SplittingDoubt doubt);  // "no_levels", ...

// Beyond it the law of the replicates has a tail that so few of them do not show.
inline constexpr double kMaxRelativeSpread = 1.0;
inline constexpr double kMinAcceptance = 0.05;
// Two-sided, of the test behind kDrawsDisagree.
inline constexpr double kDrawsSignificanceLevel = 1e-3;

struct SplittingRate {
  double estimate = 0.0;  // mean of the replicates: unbiased; NaN without levels
  double standard_error = 0.0;
  double relative_spread = 0.0;  // standard deviation of a replicate over the mean
  Interval interval;             // stats/lognormal_mean.h; [0, 1] where there is none
  // What the first particles alone allow, by the exact interval: failures of a kind to which no level leads
  // may have any rate up to here and be missed, for none was drawn.
  double unseen_up_to = 1.0;
  std::int64_t num_values = 0;  // computed, those of the pilot among them
  double least_acceptance = 1.0;
  double num_ancestors = 0.0;  // median over the replicates
  std::vector<SplittingDoubt> doubts;

  bool IsTrusted() const { return doubts.empty(); }
};

// Of at least two replicates, none if the pilot found no levels.
SplittingRate EstimateSplittingRate(const SplittingPilot& pilot,
                                    const std::vector<SplittingReplicate>& replicates,
                                    double confidence = 0.95);

}  // namespace rcme
