#include "experiments/audit/claims/power.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

#include "stats/confidence_sequence.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/score_mean.h"

namespace rcme {
namespace {

// The least integer in [0, n + 1] for which `late` is true; `late` is false up to some number and true from
// there.
std::int64_t First(std::int64_t n, const std::function<bool(std::int64_t)>& late) {
  std::int64_t low = 0, high = n + 1;
  while (low < high) {
    const std::int64_t middle = (low + high) / 2;
    if (middle > n || late(middle))
      high = middle;
    else
      low = middle + 1;
  }
  return high;
}

// The point between `found` and `not_found` at which the predicate changes.
double Border(double found, double not_found, const std::function<bool(double)>& is_found) {
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (found + not_found);
    (is_found(middle) ? found : not_found) = middle;
  }
  return found;
}

// The counts of successes at which a rate's verdict changes.
struct RateVerdicts {
  std::int64_t n, first_not_below, first_hold, last_hold, first_above;

  RateVerdicts(const Interval& allowed, std::int64_t num, double confidence) : n(num) {
    const auto sequence = [&](std::int64_t s) { return ConfidenceSequence(s, n, confidence); };
    first_not_below = First(n, [&](std::int64_t s) { return sequence(s).upper >= allowed.lower; });
    first_hold = First(n, [&](std::int64_t s) { return sequence(s).lower >= allowed.lower; });
    last_hold = First(n, [&](std::int64_t s) { return sequence(s).upper > allowed.upper; }) - 1;
    first_above = First(n, [&](std::int64_t s) { return sequence(s).lower > allowed.upper; });
  }
  double Holds(double p) const {
    return last_hold < first_hold ? 0.0 : BinomialCdf(last_hold, n, p) - BinomialCdf(first_hold - 1, n, p);
  }
  bool FindsBelow(double p) const { return BinomialCdf(first_not_below - 1, n, p) >= kPowerOfDesign; }
  bool FindsAbove(double p) const { return 1.0 - BinomialCdf(first_above - 1, n, p) >= kPowerOfDesign; }
};

// The error of sigma that moves a statistic's coverage at `quantile` to `coverage`.
double ComputeSigmaError(double coverage, int degrees_of_freedom, double quantile) {
  if (std::isinf(coverage)) return coverage < 0.0 ? -1.0 : kInfinity;
  return std::sqrt(ChiSquareQuantile(degrees_of_freedom, coverage) / quantile) - 1.0;
}

TargetPower PowerOfRate(const Target& target, std::int64_t num_trials, double confidence) {
  const auto n = std::llround(target.planned_share * static_cast<double>(num_trials));
  const RateVerdicts verdicts(target.allowed, n, confidence);
  TargetPower power;
  power.holds_at_nominal = verdicts.Holds(target.nominal);
  if (verdicts.FindsBelow(0.0)) {
    power.found.lower = Border(0.0, target.allowed.lower, [&](double p) { return verdicts.FindsBelow(p); });
  }
  if (verdicts.FindsAbove(1.0)) {
    power.found.upper = Border(1.0, target.allowed.upper, [&](double p) { return verdicts.FindsAbove(p); });
  }
  if (target.degrees_of_freedom > 0) {
    power.found_sigma = {ComputeSigmaError(power.found.lower, target.degrees_of_freedom, target.threshold),
                         ComputeSigmaError(power.found.upper, target.degrees_of_freedom, target.threshold)};
  }
  return power;
}

// The law of a mean, and how far its interval reaches to either side.
struct MeanLaw {
  double mean, standard_error, reach_below, reach_above;

  double Holds(const Interval& allowed) const {
    return std::max(0.0, NormalCdf((mean - reach_below - allowed.lower) / standard_error) +
                             NormalCdf((allowed.upper - mean - reach_above) / standard_error) - 1.0);
  }
  bool IsFound(const Interval& allowed) const {
    return NormalCdf((allowed.lower - mean - reach_above) / standard_error) >= kPowerOfDesign ||
           NormalCdf((mean - reach_below - allowed.upper) / standard_error) >= kPowerOfDesign;
  }
};

// The values F(x / c) that n trials are expected to give, with x chi-square distributed and c = (assumed
// sigma / true sigma)^2.
ScoreMean ExpectedPits(int degrees_of_freedom, double sigma_error, double n) {
  constexpr int kNumBins = 128;
  const double c = (1.0 + sigma_error) * (1.0 + sigma_error);
  ScoreMean expected;
  for (int b = 0; b < kNumBins; ++b) {
    const double end = (b + 1.0) / kNumBins;
    const double up_to =
        end < 1.0 ? ChiSquareCdf(degrees_of_freedom, c * ChiSquareQuantile(degrees_of_freedom, end)) : 1.0;
    expected.Add((b + 0.5) / kNumBins, std::llround(n * up_to) - expected.n());
  }
  return expected;
}

MeanLaw MeanPitLaw(int degrees_of_freedom, double sigma_error, double n, double confidence) {
  const ScoreMean expected = ExpectedPits(degrees_of_freedom, sigma_error, n);
  const Interval sequence = expected.Sequence(confidence);
  const double mean = expected.mean();
  return {mean, expected.standard_deviation() / std::sqrt(n), mean - sequence.lower, sequence.upper - mean};
}

TargetPower PowerOfMeanPit(const Target& target, std::int64_t num_trials, double confidence) {
  constexpr double kMostSigmaError = 9.0, kLeastSigmaError = -0.9;
  const double n = target.planned_share * static_cast<double>(num_trials);
  const auto law = [&](double error) { return MeanPitLaw(target.degrees_of_freedom, error, n, confidence); };
  const auto is_found = [&](double error) { return law(error).IsFound(target.allowed); };
  TargetPower power;
  power.holds_at_nominal = law(0.0).Holds(target.allowed);
  power.found_sigma = {is_found(kLeastSigmaError) ? Border(kLeastSigmaError, 0.0, is_found) : -1.0,
                       is_found(kMostSigmaError) ? Border(kMostSigmaError, 0.0, is_found) : kInfinity};
  if (power.found_sigma.upper < kInfinity) power.found.lower = law(power.found_sigma.upper).mean;
  if (power.found_sigma.lower > -1.0) power.found.upper = law(power.found_sigma.lower).mean;
  return power;
}

// Student's interval at the single look, or the sequence of a bounded mean, which reaches about as far as a
// normal one at the cost of repeated looks.
TargetPower PowerOfMean(const Target& target, std::int64_t num_trials, double confidence) {
  const double n = target.planned_share * static_cast<double>(num_trials);
  constexpr double kNumStakes = 14.0;  // they share the initial capital (stats/score_mean.cc)
  const double standard_error = target.planned_spread / std::sqrt(n), tail = 0.5 * (1.0 - confidence);
  const double reach = standard_error * (target.kind == Target::Kind::kBoundedMean
                                             ? std::sqrt(2.0 * std::log(2.0 * kNumStakes / tail))
                                             : StudentQuantile(static_cast<int>(n) - 1, 1.0 - tail));
  const double beyond = reach + NormalQuantile(kPowerOfDesign) * standard_error;
  Interval allowed = target.allowed;  // a border at the end of the possible range is never crossed
  if (target.kind == Target::Kind::kBoundedMean) {
    if (allowed.lower <= target.range.lower) allowed.lower = -kInfinity;
    if (allowed.upper >= target.range.upper) allowed.upper = kInfinity;
  }
  TargetPower power;
  power.holds_at_nominal = MeanLaw{target.nominal, standard_error, reach, reach}.Holds(allowed);
  power.found = {allowed.lower - beyond, allowed.upper + beyond};
  return power;
}

TargetPower ComputePower(const Target& target, std::int64_t num_trials, double confidence) {
  if (target.kind == Target::Kind::kMeanPit) return PowerOfMeanPit(target, num_trials, confidence);
  if (target.IsMean()) return PowerOfMean(target, num_trials, confidence);
  return PowerOfRate(target, num_trials, confidence);
}

}  // namespace

TargetPower FindPower(const Target& target, std::int64_t num_trials, double confidence) {
  // Everything on which the power depends. The noise levels of a claim, and many claims, have it in common.
  using Key = std::pair<std::array<std::int64_t, 3>, std::array<double, 9>>;
  static std::mutex mutex;
  static std::map<Key, TargetPower> known;
  const auto or_zero = [](double x) { return std::isnan(x) ? 0.0 : x; };  // a NaN cannot be a key of a map
  const Key key{{static_cast<std::int64_t>(target.kind), target.degrees_of_freedom, num_trials},
                {or_zero(target.nominal), target.allowed.lower, target.allowed.upper,
                 or_zero(target.threshold), target.range.lower, target.range.upper, target.planned_share,
                 or_zero(target.planned_spread), confidence}};
  const std::lock_guard lock(mutex);
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  return known[key] = ComputePower(target, num_trials, confidence);
}

double HoldsAtNominal(const Claim& claim, Budget budget, double confidence) {
  double misses = 0.0;
  for (const Check& check : claim.checks) {
    if (check.sigma_px > kAssertedSigmaPx) continue;
    for (const Target& target : check.targets) {
      if (!target.IsClaimed()) continue;
      misses += 1.0 - FindPower(target, check.limits.Max(budget), confidence).holds_at_nominal;
    }
  }
  return std::max(0.0, 1.0 - misses);
}

std::string DescribeFound(const TargetPower& power) {
  if (!std::isnan(power.found_sigma.lower)) {
    if (std::isinf(power.found_sigma.upper))
      return fmt::format("sigma off by {:.1f} %", 100.0 * power.found_sigma.lower);
    return fmt::format("sigma off by {:.1f} or {:+.1f} %", 100.0 * power.found_sigma.lower,
                       100.0 * power.found_sigma.upper);
  }
  const bool finds_below = std::isfinite(power.found.lower), finds_above = std::isfinite(power.found.upper);
  if (finds_below && finds_above) {
    return fmt::format("below {:.3g} or above {:.3g}", power.found.lower, power.found.upper);
  }
  if (finds_below) return fmt::format("below {:.3g}", power.found.lower);
  return finds_above ? fmt::format("above {:.3g}", power.found.upper) : "nothing";
}

}  // namespace rcme
