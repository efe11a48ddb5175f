#include "experiments/claims/decide_check.h"

#include <algorithm>
#include <cmath>

#include "experiments/for_each_index.h"
#include "stats/confidence_sequence.h"
#include "stats/distributions.h"
#include "stats/moments.h"

namespace rcme {
namespace {

// A confidence sequence needs about this many times the trials of an interval of fixed n (equivalence.h).
constexpr double kPriceOfLooking = 2.5;

// The trials of one target, counted.
struct Tally {
  Moments moments;  // of the statistic; of an indicator for rates
  std::int64_t num_successes = 0;

  void Add(const Target& target, double value) {
    if (std::isnan(value)) return;
    if (target.kind == Target::Kind::kCoverage) value = value >= 0.0 && value <= target.threshold;
    if (target.kind == Target::Kind::kAtMost) value = value <= target.threshold;
    if (target.kind == Target::Kind::kRate) value = value != 0.0;
    if (target.kind != Target::Kind::kMean) num_successes += value != 0.0;
    moments.Add(value);
  }
};

Interval StudentInterval(const Moments& moments, double confidence) {
  if (moments.n() < 2)
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const double quantile = StudentQuantile(static_cast<int>(moments.n() - 1), 0.5 * (1.0 + confidence));
  return Around(moments.mean(), quantile * moments.standard_error());
}

// Trials of the check until a mean's interval fits between the estimate and the nearest border.
double TrialsToDecideMean(const Moments& moments, const Interval& interval, const Interval& allowed) {
  const double gap =
      std::min(std::abs(moments.mean() - allowed.lower), std::abs(moments.mean() - allowed.upper));
  const double half_width = 0.5 * (interval.upper - interval.lower);
  return static_cast<double>(moments.n()) * half_width * half_width / (gap * gap);
}

TargetResult Look(const Target& target, const Tally& tally, std::int64_t num_trials, double confidence,
                  bool is_last) {
  const bool is_mean = target.kind == Target::Kind::kMean;
  TargetResult result;
  result.n = tally.moments.n();
  result.measured = is_mean ? tally.moments.mean()
                            : static_cast<double>(tally.num_successes) / static_cast<double>(result.n);
  result.interval = is_mean ? StudentInterval(tally.moments, confidence)
                            : ConfidenceSequence(tally.num_successes, result.n, confidence);
  if (!target.IsClaimed()) return result;
  result.verdict =
      is_mean && !is_last ? Verdict::kUndecided : DecideEquivalence(result.interval, target.allowed);
  if (result.verdict == Verdict::kUndecided && result.n > 0) {
    const double outcomes =
        is_mean ? TrialsToDecideMean(tally.moments, result.interval, target.allowed)
                : kPriceOfLooking * TrialsToDecide(result.measured, target.allowed, confidence);
    result.trials_to_decide = outcomes * static_cast<double>(num_trials) / static_cast<double>(result.n);
  }
  return result;
}

std::vector<Outcome> RunTrials(const Check& check, const CheckRun& run, std::int64_t begin,
                               std::int64_t end) {
  std::vector<Outcome> outcomes(static_cast<size_t>(end - begin));
  const auto run_one = [&](std::int64_t i) {
    outcomes[static_cast<size_t>(i)] =
        check.trial({run.seed, run.condition, static_cast<std::uint32_t>(begin + i), 0});
  };
  ForEachIndex(end - begin, check.is_timed ? 1 : run.num_threads, run_one);
  return outcomes;
}

}  // namespace

CheckResult DecideCheck(const Check& check, const CheckRun& run) {
  if (!check.not_possible.empty()) return {};
  constexpr std::int64_t kFirstLook = 64, kMaxBatch = 100'000;
  const std::int64_t max_trials = check.limits.Max(run.budget);
  std::vector<Tally> tallies(check.targets.size());
  const bool claims_mean = std::any_of(check.targets.begin(), check.targets.end(), [](const Target& target) {
    return target.kind == Target::Kind::kMean && target.IsClaimed();
  });
  CheckResult result;
  bool is_decided = false;
  do {
    const std::int64_t begin = result.num_trials;
    const std::int64_t batch = std::clamp(begin / 4, kFirstLook, kMaxBatch);
    const std::int64_t end = std::min(begin + batch, max_trials);
    for (const Outcome& outcome : RunTrials(check, run, begin, end)) {
      for (size_t t = 0; t < tallies.size(); ++t) {
        tallies[t].Add(check.targets[t], outcome.at(check.targets[t].statistic));
      }
    }
    result.num_trials = end;
    result.targets.clear();
    std::vector<std::optional<Verdict>> verdicts;
    for (size_t t = 0; t < tallies.size(); ++t) {
      result.targets.push_back(Look(check.targets[t], tallies[t], end, run.confidence, end == max_trials));
      verdicts.push_back(result.targets.back().verdict);
    }
    result.verdict = Together(verdicts);
    is_decided = !claims_mean && result.verdict && *result.verdict != Verdict::kUndecided;
  } while (result.num_trials < max_trials && !(is_decided && result.num_trials >= check.limits.min));
  return result;
}

}  // namespace rcme
