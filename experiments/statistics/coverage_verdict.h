// Judges whether a confidence region covers as often as it states.
#pragma once

#include <cstdint>
#include <string>

#include "stats/equivalence.h"

namespace rcme {

// The nominal coverage of a 95 % region, and the margin within which a coverage counts as right. Margin and
// rule are those of the audit's coverage claims.
inline constexpr double kNominalCoverage = 0.95, kCoverageMargin = 0.01;

// Too narrow: the region covers less often than it states. Too wide: more often.
enum class RegionVerdict { kCovers, kTooNarrow, kTooWide, kUndecided };
const char* Name(RegionVerdict verdict);  // "covers", "too narrow", "too wide", "undecided"

struct CoverageVerdict {
  RegionVerdict verdict = RegionVerdict::kUndecided;
  // If undecided: about how many trials in all would decide with probability 0.9, if the measured coverage
  // is the true one. Infinite at a border of the margin.
  double trials_to_decide = 0.0;
};

// Judges a coverage measured in `n` of `num_trials` trials, with its 95 % interval. An interval that holds
// at every look (is_of_fixed_n false) needs about 2.5 times as many trials.
CoverageVerdict JudgeCoverage(double coverage, const Interval& interval, std::int64_t n,
                              std::int64_t num_trials, bool is_of_fixed_n);

// "undecided, about 12000 trials would do"
std::string DescribeCoverageVerdict(const CoverageVerdict& verdict);

}  // namespace rcme
