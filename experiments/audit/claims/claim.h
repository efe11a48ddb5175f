// A claim: one sentence about the estimator, as a check that can fail.
//
// A claim is checked under one or more conditions. Each check repeats an independent trial. A trial yields
// numbers; targets say which rate or mean of them is claimed, its nominal value, and how much it may deviate.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/data/data_source.h"
#include "stats/equivalence.h"
#include "stats/random.h"

namespace rcme {

// The result of one trial, one number per statistic. NaN means that the trial does not contribute to a
// statistic, for example a rate among failures if nothing failed. It then counts as a trial of the check, but
// not in the target's n. If a trial could not compute its statistic (a degenerate sample), the number is
// infinity instead.
using Outcome = std::vector<double>;

// A measured number and the claim about it.
struct Target {
  enum class Kind {
    kCoverage,  // share of trials with 0 <= statistic <= threshold
    kAtMost,    // share of trials with statistic <= threshold
    kRate,      // share of trials with statistic != 0
    kMean,      // mean of the statistic
    // mean of F(statistic), F the chi-square distribution function; 1 for infinite or negative ones
    kMeanPit,
    kBoundedMean,  // mean of a statistic in [range.lower, range.upper]
  };
  std::string quantity;
  Kind kind = Kind::kRate;
  double nominal = std::numeric_limits<double>::quiet_NaN();  // the claimed value
  // The range that counts as nominal. Unbounded: nothing is claimed, the number is only measured.
  Interval allowed{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  double threshold = std::numeric_limits<double>::quiet_NaN();
  size_t statistic = 0;        // index into the outcome
  int degrees_of_freedom = 0;  // of the statistic's claimed chi-square law; 0: another law
  Interval range{0.0, 1.0};
  // Not every estimator states the statistic. Nothing is claimed if none of at least kMostSilentTrials trials
  // states it.
  bool is_if_stated = false;
  // Expectations of the design, only for planning (power.h).
  double planned_share = 1.0;
  double planned_spread = std::numeric_limits<double>::quiet_NaN();

  bool IsMean() const { return kind == Kind::kMean || kind == Kind::kMeanPit || kind == Kind::kBoundedMean; }
  bool IsClaimed() const { return std::isfinite(allowed.lower) || std::isfinite(allowed.upper); }
  // Whether the target belongs to a confidence region: a coverage, or the law from which regions are made.
  bool IsOfRegion() const { return degrees_of_freedom > 0; }
};

// An estimator that states something in one of a hundred answers is missed with probability 0.007.
inline constexpr std::int64_t kMostSilentTrials = 500;

// Makes a target: a rate or a mean, claimed or only measured.
inline Target ClaimedRate(const std::string& quantity, double nominal, const Interval& allowed,
                          size_t statistic = 0) {
  Target target{quantity, Target::Kind::kRate, nominal, allowed};
  target.statistic = statistic;
  return target;
}
inline Target ClaimedMean(const std::string& quantity, double nominal, const Interval& allowed,
                          size_t statistic = 0) {
  Target target = ClaimedRate(quantity, nominal, allowed, statistic);
  target.kind = Target::Kind::kMean;
  return target;
}
inline Target IfStated(Target target) {
  target.is_if_stated = true;
  return target;
}
inline Target MeasuredRate(const std::string& quantity, size_t statistic = 0) {
  Target target{quantity};
  target.statistic = statistic;
  return target;
}
inline Target MeasuredMean(const std::string& quantity, size_t statistic = 0) {
  Target target{quantity, Target::Kind::kMean};
  target.statistic = statistic;
  return target;
}

enum class Budget { kQuick, kFull };

// A check stops at its first verdict, but not before `min` trials, so that the measured number is useful, and
// not after the budget's trials. Means without bounds are examined once, at the end.
struct TrialLimits {
  std::int64_t min = 0, quick = 0, full = 0;
  std::int64_t Max(Budget budget) const { return budget == Budget::kQuick ? quick : full; }
};

struct Check {
  Settings conditions;                   // key, value; for the reader
  std::optional<double> sigma_px = 0.5;  // its noise level; nullopt: the claim is not judged by noise levels
  std::vector<Target> targets;
  TrialLimits limits;
  std::function<Outcome(const StreamName&)> trial;  // a pure function of the name
  std::string not_possible;  // why there are no trials and no targets; empty: there are
  std::string not_stated;    // reason given if all claimed targets are is_if_stated and none was stated
  // The statistic that measures the difficulty of a trial's problem. The coverage of the first target is
  // reported for fifths of the trials in order of difficulty.
  std::optional<size_t> difficulty_statistic;
  bool is_timed = false;  // measures time: trials run one after the other, with nothing in parallel
};

struct Claim {
  std::string id;         // "inlier.true_pose.rank_aware"; the family is the part before the first point
  std::string label;      // of the paper's equation or section
  std::string reading;    // "as printed", "rank-aware", ...
  std::string sentence;   // what is claimed
  std::string statistic;  // what is measured
  std::string figure_x;   // the condition on a figure's x axis; empty: no figure
  std::vector<Check> checks;

  std::string family() const { return id.substr(0, id.find('.')); }
};

// The noise level at which the paper asserts its formulas, px.
inline constexpr double kAssertedSigmaPx = 0.5;

}  // namespace rcme
