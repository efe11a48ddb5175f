#include "stats/equivalence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/distributions.h"

namespace rcme {

const char* Name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kHolds:
      return "holds";
    case Verdict::kDoesNotHold:
      return "does not hold";
    case Verdict::kUndecided:
      break;
  }
  return "undecided";
}

Interval Around(double nominal, double margin) { return {nominal - margin, nominal + margin}; }

Verdict DecideEquivalence(const Interval& interval, const Interval& allowed) {
  if (std::isnan(interval.lower) || std::isnan(interval.upper)) return Verdict::kUndecided;
  if (interval.lower >= allowed.lower && interval.upper <= allowed.upper) return Verdict::kHolds;
  if (interval.upper < allowed.lower || interval.lower > allowed.upper) return Verdict::kDoesNotHold;
  return Verdict::kUndecided;
}

double TrialsToDecide(double rate, const Interval& allowed, double confidence) {
  constexpr double kPower = 0.9;
  double gap = std::numeric_limits<double>::infinity();
  int num_borders = 0;
  for (const double border : {allowed.lower, allowed.upper}) {
    if (border <= 0.0 || border >= 1.0) continue;
    gap = std::min(gap, std::abs(rate - border));
    ++num_borders;
  }
  const bool must_clear_both = num_borders == 2 && rate > allowed.lower && rate < allowed.upper;
  const double miss = (1.0 - kPower) / (must_clear_both ? 2.0 : 1.0);
  const double tail = 0.5 * (1.0 - confidence);
  const double z = NormalQuantile(1.0 - tail) + NormalQuantile(1.0 - miss);
  return std::max(z * z * rate * (1.0 - rate) / (gap * gap), -std::log(tail) / gap);
}

}  // namespace rcme
