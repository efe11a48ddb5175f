// Whether a confidence region covers as often as it says: the words beside a measured coverage.
#pragma once

#include <cstdint>
#include <string>

#include "stats/equivalence.h"

namespace rcme {

// The 95 % region of a sound estimator; within the margin still counts as covering. Margin and rule are those
// of the audit's coverage claims.
inline constexpr double kNominalCoverage = 0.95, kCoverageMargin = 0.01;

// Too narrow: the region covers less often than it says; too wide: more often.
enum class RegionVerdict { kCovers, kTooNarrow, kTooWide, kUndecided };
const char* Name(RegionVerdict verdict);  // "covers", "too narrow", "too wide", "undecided"

struct CoverageVerdict {
  RegionVerdict verdict = RegionVerdict::kUndecided;
  // Where undecided: about how many trials in all decide with probability 0.9, if the measured coverage is
  // the truth; infinite on a border of the margin.
  double trials_to_decide = 0.0;
};

// Of a coverage measured in `n` of `num_trials` trials, with its 95 % interval. An interval that holds for
// any number of trials (is_of_fixed_n false) needs about 2.5 times as many.
CoverageVerdict JudgeCoverage(double coverage, const Interval& interval, std::int64_t n,
                              std::int64_t num_trials, bool is_of_fixed_n);

// "undecided, about 12000 trials would do"
std::string DescribeCoverageVerdict(const CoverageVerdict& verdict);

}  // namespace rcme
