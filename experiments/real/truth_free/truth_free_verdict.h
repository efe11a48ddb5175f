#pragma once

#include "experiments/core/text/pick_name.h"
#include "stats/intervals.h"

namespace rcme {

enum class TruthFreeVerdict { kHolds, kTooSmall, kTooLarge, kUndecided, kNoData };

// "holds", "too small", ...
inline const char* VerdictName(TruthFreeVerdict verdict) {
  return PickName(verdict, {"holds", "too small", "too large", "undecided", "no data"});
}

// The verdict from the interval of a quantity whose correct value is `right`: holds if the interval lies
// within `nominal`, else too small or too large if it excludes `right`, else undecided.
inline TruthFreeVerdict VerdictOnInterval(const Interval& interval, double right, const Interval& nominal) {
  if (interval.lower >= nominal.lower && interval.upper <= nominal.upper) return TruthFreeVerdict::kHolds;
  if (interval.lower > right) return TruthFreeVerdict::kTooLarge;
  if (interval.upper < right) return TruthFreeVerdict::kTooSmall;
  return TruthFreeVerdict::kUndecided;
}

}  // namespace rcme
