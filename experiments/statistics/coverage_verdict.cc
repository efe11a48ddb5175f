#include "experiments/statistics/coverage_verdict.h"

#include <fmt/format.h>

#include <cmath>

#include "experiments/core/text/pick_name.h"

namespace rcme {

namespace {

RegionVerdict JudgeRegion(const Interval& interval, const Interval& allowed) {
  switch (DecideEquivalence(interval, allowed)) {
    case Verdict::kHolds:
      return RegionVerdict::kCovers;
    case Verdict::kDoesNotHold:
      return interval.upper < allowed.lower ? RegionVerdict::kTooNarrow : RegionVerdict::kTooWide;
    case Verdict::kUndecided:
      break;
  }
  return RegionVerdict::kUndecided;
}

}  // namespace

const char* Name(RegionVerdict verdict) {
  return PickName(verdict, {"covers", "too narrow", "too wide", "undecided"});
}

CoverageVerdict JudgeCoverage(double coverage, const Interval& interval, std::int64_t n,
                              std::int64_t num_trials, bool is_of_fixed_n) {
  const Interval allowed = Around(kNominalCoverage, kCoverageMargin);
  CoverageVerdict judged{JudgeRegion(interval, allowed), 0.0};
  if (judged.verdict != RegionVerdict::kUndecided) return judged;
  const double price_of_looking = is_of_fixed_n ? 1.0 : 2.5;
  judged.trials_to_decide = price_of_looking * TrialsToDecide(coverage, allowed) *
                            static_cast<double>(num_trials) / static_cast<double>(n);
  return judged;
}

std::string DescribeCoverageVerdict(const CoverageVerdict& verdict) {
  const std::string name = Name(verdict.verdict);
  if (verdict.verdict != RegionVerdict::kUndecided) return name;
  if (std::isnan(verdict.trials_to_decide)) return name + ", more conditions would decide";
  if (!std::isfinite(verdict.trials_to_decide)) return name + ", on the border of the margin";
  const double step = std::pow(10.0, std::floor(std::log10(verdict.trials_to_decide)) - 1.0);  // two digits
  return fmt::format("{}, about {:.0f} trials would do", name,
                     step * std::round(verdict.trials_to_decide / step));
}

}  // namespace rcme
