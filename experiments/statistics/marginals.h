// Measures how an estimator performs in each regime of a run: conditions in which one factor, or each of
// two, has a certain level. Conditions count as a random sample of a population (stats/population_rate.h),
// so each regime is a population of its own. Chosen draws (Population::draws) are no sample: their intervals
// are for these very conditions with infinitely many trials each.
//
// The intervals are simultaneous (Bonferroni): all of them, over estimators, regimes and quantities, hold
// together with the stated confidence. It is therefore allowed to search for the worst regime.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "stats/intervals.h"
#include "stats/moments.h"

namespace rcme {

// Quantities by which a regime is judged. The claimed value is what the estimator itself states, or 0.95 for
// its regions.
enum class MarginalQuantity {
  kFailedLessStated,  // share of answers that failed minus the mean of their stated probabilities; claimed 0
  kSureFailed,        // the same for answers with a stated probability of at most kSureBelow
  kSureCoverage,      // truth within the 95 % region; of answers with a stated probability of at most
                      // kCertainBelow, or of the successes of an estimator that states none; claimed 0.95
  kFailure            // share of trials that failed; no claimed value
};
inline constexpr MarginalQuantity kMarginalQuantities[] = {
    MarginalQuantity::kFailedLessStated, MarginalQuantity::kSureFailed, MarginalQuantity::kSureCoverage,
    MarginalQuantity::kFailure};
std::string Name(MarginalQuantity quantity);
inline constexpr double kCertainBelow = 0.01;

// The conditions of a run in which factors have certain levels: "noise = octave, sigma_px 0.8 to 1.6".
struct Regime {
  std::string text;       // empty: all conditions
  std::vector<bool> has;  // by condition
};
// Lists the regimes: all conditions; each level of each factor; and with `with_pairs` each pair of levels of
// two factors. A factor with more than kMaxLevels numeric levels is divided into fifths of its conditions.
// Regimes with fewer than kLeastConditions conditions, or with all of them, are left out.
std::vector<Regime> ListRegimes(const RunDescription& run, bool with_pairs);
inline constexpr size_t kMaxLevels = 8, kLeastConditions = 5;

struct Marginal {
  std::string estimator, regime;
  MarginalQuantity quantity;
  double value = 0.0;
  Interval interval;                                          // simultaneous
  double claimed = std::numeric_limits<double>::quiet_NaN();  // NaN: nothing is claimed
  // Distance of the interval from the claimed value, in half widths of the interval; 0 if the interval
  // contains it.
  double excess = 0.0;
  // For a coverage: the sharpness of the regions, as geometric mean of sd_over_crb over the same answers.
  // NaN: not known, or not a coverage.
  double sd_over_crb = std::numeric_limits<double>::quiet_NaN();
  std::int64_t num_conditions = 0, n = 0;
};

struct Marginals {
  double confidence = 0.95;             // of all intervals together
  bool is_of_these_conditions = false;  // the conditions are chosen draws
  size_t num_intervals = 0;
  std::vector<Marginal> rows;  // greatest excess first, then by regime as listed
};

// The moments over the trials of one condition of a quantity of one estimator.
struct ConditionMoments {
  Moments of_quantity, log_sd_over_crb;  // log_sd_over_crb: only for a coverage, of answers with a bound
};
// Returns the moments by condition. Throws InputError for weighted trials.
std::vector<ConditionMoments> CollectConditionMoments(const ResultStore& run, size_t estimator,
                                                      MarginalQuantity quantity);

struct MarginalOptions {
  bool with_pairs = false;
  std::vector<std::string> estimators;  // labels; empty: all
};

// Throws InputError for weighted trials, a run with fewer than kLeastConditions conditions, an unknown label,
// and chosen draws with common or repeated scenes or a stopping rule.
Marginals MeasureMarginals(const ResultStore& run, const MarginalOptions& options);

}  // namespace rcme
