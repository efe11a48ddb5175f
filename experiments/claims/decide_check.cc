#include "experiments/claims/decide_check.h"

#include <algorithm>
#include <cmath>

#include "experiments/base/for_each_index.h"
#include "stats/confidence_sequence.h"
#include "stats/distributions.h"
#include "stats/moments.h"
#include "stats/score_mean.h"

namespace rcme {
namespace {

// A confidence sequence needs about this many times the trials of an interval of fixed n (equivalence.h).
constexpr double kPriceOfLooking = 2.5;

bool HasSequenceOfMean(const Target& target) {
  return target.kind == Target::Kind::kMeanPit || target.kind == Target::Kind::kBoundedMean;
}

// What is averaged of a statistic, in the target's range.
double BoundedNumber(const Target& target, double value) {
  if (target.kind == Target::Kind::kBoundedMean) return value;
  return value >= 0.0 && std::isfinite(value) ? ChiSquareCdf(target.degrees_of_freedom, value) : 1.0;
}

// The trials of one target, counted.
struct Tally {
  explicit Tally(const Target& target) : bounded(target.range) {}

  Moments moments;    // of the statistic; of an indicator for rates
  ScoreMean bounded;  // where its sequence is asked for
  std::int64_t num_successes = 0;

  void Add(const Target& target, double value) {
    if (std::isnan(value)) return;
    if (HasSequenceOfMean(target)) {
      bounded.Add(BoundedNumber(target, value));
      return;
    }
    if (target.kind == Target::Kind::kCoverage) value = value >= 0.0 && value <= target.threshold;
    if (target.kind == Target::Kind::kAtMost) value = value <= target.threshold;
    if (target.kind == Target::Kind::kRate) value = value != 0.0;
    if (target.kind != Target::Kind::kMean) num_successes += value != 0.0;
    moments.Add(value);
  }
};

// n, the measured number and its interval.
TargetResult Measure(const Target& target, const Tally& tally, double confidence) {
  TargetResult result;
  if (HasSequenceOfMean(target)) {
    result.n = tally.bounded.n();
    result.measured = tally.bounded.mean();
    result.interval = tally.bounded.Sequence(confidence);
    return result;
  }
  const bool is_mean = target.kind == Target::Kind::kMean;
  result.n = tally.moments.n();
  result.measured = is_mean ? tally.moments.mean()
                            : static_cast<double>(tally.num_successes) / static_cast<double>(result.n);
  result.interval = is_mean ? StudentInterval(tally.moments, confidence)
                            : ConfidenceSequence(tally.num_successes, result.n, confidence);
  return result;
}

// Trials of the check until a mean's interval fits between the estimate and the nearest border.
double TrialsToDecideMean(const TargetResult& result, const Interval& allowed) {
  const double gap =
      std::min(std::abs(result.measured - allowed.lower), std::abs(result.measured - allowed.upper));
  const double half_width = 0.5 * (result.interval.upper - result.interval.lower);
  return static_cast<double>(result.n) * half_width * half_width / (gap * gap);
}

TargetResult Look(const Target& target, const Tally& tally, std::int64_t num_trials, double confidence,
                  bool is_last) {
  TargetResult result = Measure(target, tally, confidence);
  if (!target.IsClaimed()) return result;
  const bool must_wait = target.kind == Target::Kind::kMean && !is_last;
  result.verdict = must_wait ? Verdict::kUndecided : DecideEquivalence(result.interval, target.allowed);
  if (result.verdict == Verdict::kUndecided && result.n > 0) {
    const double outcomes =
        target.IsMean() ? TrialsToDecideMean(result, target.allowed)
                        : kPriceOfLooking * TrialsToDecide(result.measured, target.allowed, confidence);
    result.trials_to_decide = outcomes * static_cast<double>(num_trials) / static_cast<double>(result.n);
  }
  return result;
}

// How hard a trial's problem was, and whether the first target's statistic covered.
struct RatedTrial {
  double difficulty;
  bool is_covered;
};

std::vector<DifficultyFifth> Fifths(std::vector<RatedTrial> trials, double confidence) {
  constexpr size_t kParts = 5;
  std::ranges::stable_sort(trials, {}, &RatedTrial::difficulty);
  std::vector<DifficultyFifth> fifths;
  for (size_t part = 0; part < kParts && trials.size() >= kParts; ++part) {
    const auto begin = trials.begin() + static_cast<std::ptrdiff_t>(part * trials.size() / kParts);
    const auto end = trials.begin() + static_cast<std::ptrdiff_t>((part + 1) * trials.size() / kParts);
    const std::int64_t num_covered =
        std::count_if(begin, end, [](const RatedTrial& t) { return t.is_covered; });
    const std::int64_t n = end - begin;
    fifths.push_back({begin->difficulty, (end - 1)->difficulty,
                      static_cast<double>(num_covered) / static_cast<double>(n),
                      ConfidenceSequence(num_covered, n, confidence), n});
  }
  return fifths;
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
  std::vector<Tally> tallies(check.targets.begin(), check.targets.end());
  const bool claims_mean = std::any_of(check.targets.begin(), check.targets.end(), [](const Target& target) {
    return target.kind == Target::Kind::kMean && target.IsClaimed();
  });
  CheckResult result;
  std::vector<RatedTrial> rated;
  bool is_decided = false;
  do {
    const std::int64_t begin = result.num_trials;
    const std::int64_t batch = std::clamp(begin / 4, kFirstLook, kMaxBatch);
    const std::int64_t end = std::min(begin + batch, max_trials);
    for (const Outcome& outcome : RunTrials(check, run, begin, end)) {
      for (size_t t = 0; t < tallies.size(); ++t) {
        tallies[t].Add(check.targets[t], outcome.at(check.targets[t].statistic));
      }
      if (!check.difficulty_statistic) continue;
      const Target& first = check.targets.front();
      const double difficulty = outcome.at(*check.difficulty_statistic), value = outcome.at(first.statistic);
      if (std::isnan(value) || std::isnan(difficulty)) continue;
      rated.push_back({difficulty, value >= 0.0 && value <= first.threshold});
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
  result.fifths = Fifths(std::move(rated), run.confidence);
  return result;
}

}  // namespace rcme
