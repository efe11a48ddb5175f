// A claim: one sentence about the estimator as a check that can fail.
//
// A claim is checked under one or more conditions. Each check repeats an independent trial; a trial yields
// numbers, and targets say which rate or mean of them is claimed to be what, and how far off still counts.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/data/data_source.h"
#include "experiments/data/settings.h"
#include "stats/equivalence.h"
#include "stats/random.h"

namespace rcme {

// What one trial yields, one number per statistic. NaN: the trial says nothing about that statistic (a rate
// among failures, where nothing failed); it counts as a trial of the check, not in the target's n. A trial
// that could not produce its statistic (a degenerate sample) is no such case: it yields infinity.
using Outcome = std::vector<double>;

// One measured number and what is claimed of it.
struct Target {
  enum class Kind {
    kCoverage,  // share of trials with 0 <= statistic <= threshold
    kAtMost,    // share of trials with statistic <= threshold
    kRate,      // share of trials with statistic != 0
    kMean,      // mean of the statistic
    kMeanPit,   // mean of F(statistic), F the chi-square law's distribution function; infinite or negative: 1
    kBoundedMean,  // mean of a statistic in [range.lower, range.upper]
  };
  std::string quantity;
  Kind kind = Kind::kRate;
  double nominal = std::numeric_limits<double>::quiet_NaN();  // what is claimed
  // What still counts as nominal. Unbounded: nothing is claimed, the number is only measured.
  Interval allowed{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  double threshold = std::numeric_limits<double>::quiet_NaN();
  size_t statistic = 0;        // index into the outcome
  int degrees_of_freedom = 0;  // of the chi-square law the statistic is claimed to have; 0: another law
  Interval range{0.0, 1.0};
  // Not every estimator states the statistic. As long as none of the trials says anything of it, and there
  // were kMostSilentTrials or more, nothing is claimed.
  bool is_if_stated = false;
  // What the design expects, for planning alone (power.h).
  double planned_share = 1.0;
  double planned_spread = std::numeric_limits<double>::quiet_NaN();

  bool IsMean() const { return kind == Kind::kMean || kind == Kind::kMeanPit || kind == Kind::kBoundedMean; }
  bool IsClaimed() const { return std::isfinite(allowed.lower) || std::isfinite(allowed.upper); }
  // Whether it is a confidence region's: of a coverage or of the law that regions are made of.
  bool IsOfRegion() const { return degrees_of_freedom > 0; }
};

// Who states something in one answer of a hundred is missed with probability 0.007.
inline constexpr std::int64_t kMostSilentTrials = 500;

// A rate or mean with what is claimed of it, or only measured.
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

// A check stops at its first verdict, not before `min` trials (so that the measured number is worth reading)
// and not after the budget's. Means without bounds are looked at once, at the end.
struct TrialLimits {
  std::int64_t min = 0, quick = 0, full = 0;
  std::int64_t Max(Budget budget) const { return budget == Budget::kQuick ? quick : full; }
};

struct Check {
  Settings conditions;  // for people: key, value
  std::optional<double> sigma_px =
      0.5;  // the noise level it belongs to; nothing: the claim is not judged by noise levels
  std::vector<Target> targets;
  TrialLimits limits;
  std::function<Outcome(const StreamName&)> trial;  // a pure function of the name
  std::string not_possible;  // why there are no trials (and then no targets either); empty: there are
  std::string not_stated;    // what is said where every claimed target is if stated, and none is
  // The statistic that says how hard a trial's problem is: the coverage of the first target is given by
  // fifths of the trials in its order.
  std::optional<size_t> difficulty_statistic;
  bool is_timed = false;  // measures time: trials run one after the other, nothing beside them
};

struct Claim {
  std::string id;         // "inlier.true_pose.rank_aware"; the family is the part before the first point
  std::string label;      // of the paper's equation or section
  std::string reading;    // "as printed", "rank-aware", ...
  std::string sentence;   // what is claimed
  std::string statistic;  // what is measured
  std::string figure_x;   // the condition a figure has along x; empty: none
  std::vector<Check> checks;

  std::string family() const { return id.substr(0, id.find('.')); }
};

// The noise level at which the paper asserts its formulas, px.
inline constexpr double kAssertedSigmaPx = 0.5;

}  // namespace rcme
