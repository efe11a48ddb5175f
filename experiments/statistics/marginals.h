// How an estimator does in each regime of a run: where one factor, or two, have a certain level. Conditions
// are taken for a random sample of a population (stats/population_rate.h), so that a regime is a population
// of its own.
//
// Intervals are simultaneous: all of them, over estimators, regimes and quantities, hold together with the
// stated confidence (Bonferroni), so that the worst regime may be looked for.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "stats/intervals.h"
#include "stats/moments.h"

namespace rcme {

// What a regime is judged by. A claim is what the estimator itself says, or 0.95 of its regions.
enum class MarginalQuantity {
  kFailedLessStated,  // share of the answers that failed, less the mean of their stated probabilities;
                      // claimed 0
  kSureFailed,        // the same of answers with a stated probability of at most kSureBelow
  kSureCoverage,      // truth within the 95 % region, of answers with a stated probability of at most
                      // kCertainBelow, or of successes of an estimator that states none; claimed 0.95
  kFailure            // share of the trials that failed; nothing is claimed
};
inline constexpr MarginalQuantity kMarginalQuantities[] = {
    MarginalQuantity::kFailedLessStated, MarginalQuantity::kSureFailed, MarginalQuantity::kSureCoverage,
    MarginalQuantity::kFailure};
std::string Name(MarginalQuantity quantity);
inline constexpr double kCertainBelow = 0.01;

// Of the run's conditions those with a level, or levels, of factors: "noise = octave, sigma_px 0.8 to 1.6".
struct Regime {
  std::string text;       // empty: all conditions
  std::vector<bool> has;  // by condition
};
// All conditions; each level of each factor, where a factor with more than kMaxLevels levels that are numbers
// is divided into fifths of its conditions; `with_pairs`: each pair of those of two factors. Regimes of fewer
// than kLeastConditions conditions, or of all, are left out.
std::vector<Regime> ListRegimes(const RunDescription& run, bool with_pairs);
inline constexpr size_t kMaxLevels = 8, kLeastConditions = 5;

struct Marginal {
  std::string estimator, regime;
  MarginalQuantity quantity;
  double value = 0.0;
  Interval interval;                                          // simultaneous
  double claimed = std::numeric_limits<double>::quiet_NaN();  // NaN: nothing
  // How far the interval lies from what is claimed, in half widths of itself; 0: the claim is in it.
  double excess = 0.0;
  // Of a coverage: how sharp its regions are, the geometric mean of sd_over_crb of the same answers. NaN: not
  // known, or no coverage.
  double sd_over_crb = std::numeric_limits<double>::quiet_NaN();
  std::int64_t num_conditions = 0, n = 0;
};

struct Marginals {
  double confidence = 0.95;  // of all intervals together
  size_t num_intervals = 0;
  std::vector<Marginal> rows;  // the farthest from what is claimed first, then by regime as listed
};

// What the trials of a condition say of a quantity of one estimator.
struct ConditionMoments {
  Moments of_quantity, log_sd_over_crb;  // the second of a coverage alone, of its answers with a bound
};
// By condition. Throws InputError for weighted trials.
std::vector<ConditionMoments> CollectConditionMoments(const ResultStore& run, size_t estimator,
                                                      MarginalQuantity quantity);

struct MarginalOptions {
  bool with_pairs = false;
  std::vector<std::string> estimators;  // labels; empty: all
};

// Throws InputError for weighted trials, for a run of fewer than kLeastConditions conditions, and for a label
// that it does not have.
Marginals MeasureMarginals(const ResultStore& run, const MarginalOptions& options);

}  // namespace rcme
