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

Verdict DecideEquivalence(const Interval& interval, double nominal, double margin) {
  const double low = nominal - margin, high = nominal + margin;
  if (std::isnan(interval.lower) || std::isnan(interval.upper)) return Verdict::kUndecided;
  if (interval.lower >= low && interval.upper <= high) return Verdict::kHolds;
  if (interval.upper < low || interval.lower > high) return Verdict::kDoesNotHold;
  return Verdict::kUndecided;
}

double TrialsToDecide(double rate, double nominal, double margin, double confidence, double power) {
  double gap = std::numeric_limits<double>::infinity();
  int num_borders = 0;
  for (const double border : {nominal - margin, nominal + margin}) {
    if (border <= 0.0 || border >= 1.0) continue;
    gap = std::min(gap, std::abs(rate - border));
    ++num_borders;
  }
  const bool must_clear_both = num_borders == 2 && std::abs(rate - nominal) < margin;
  const double miss = (1.0 - power) / (must_clear_both ? 2.0 : 1.0);
  const double tail = 0.5 * (1.0 - confidence);
  const double z = NormalQuantile(1.0 - tail) + NormalQuantile(1.0 - miss);
  return std::max(z * z * rate * (1.0 - rate) / (gap * gap), -std::log(tail) / gap);
}

}  // namespace rcme
