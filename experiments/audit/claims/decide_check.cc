#include "experiments/audit/claims/decide_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/core/work/for_each_index.h"
#include "stats/confidence_sequence.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// A confidence sequence needs about this many times the trials of an interval of fixed n (equivalence.h).
constexpr double kPriceOfLooking = 2.5;

bool HasSequenceOfMean(const Target& target) {
  return target.kind == Target::Kind::kMeanPit || target.kind == Target::Kind::kBoundedMean;
}

// The value of a statistic that is averaged, in the target's range.
double BoundedNumber(const Target& target, double value) {
  if (target.kind == Target::Kind::kBoundedMean) return value;
  return value >= 0.0 && std::isfinite(value) ? ChiSquareCdf(target.degrees_of_freedom, value) : 1.0;
}

// n, the measured number and its interval.
TargetResult Measure(const Target& target, const TargetTally& tally, double confidence) {
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

// Number of trials until a mean's interval fits between the estimate and the nearest border.
double TrialsToDecideMean(const TargetResult& result, const Interval& allowed) {
  const double gap =
      std::min(std::abs(result.measured - allowed.lower), std::abs(result.measured - allowed.upper));
  const double half_width = 0.5 * (result.interval.upper - result.interval.lower);
  return static_cast<double>(result.n) * half_width * half_width / (gap * gap);
}

TargetResult LookAt(const Target& target, const TargetTally& tally, std::int64_t num_trials,
                    double confidence, bool is_last) {
  TargetResult result = Measure(target, tally, confidence);
  const bool is_silent = target.is_if_stated && result.n == 0 && num_trials >= kMostSilentTrials;
  if (!target.IsClaimed() || is_silent) return result;
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

}  // namespace

void TargetTally::Add(const Target& target, double value) {
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

bool CanEndEarly(const Check& check) {
  bool is_claimed = false;
  for (const Target& target : check.targets) {
    if (!target.IsClaimed()) continue;
    if (target.kind == Target::Kind::kMean) return false;
    is_claimed = true;
  }
  return is_claimed;
}

std::int64_t NextLook(const Check& check, Budget budget, std::int64_t num_trials) {
  constexpr std::int64_t kFirstLook = 64, kMaxBatch = 100'000;
  return std::min(num_trials + std::clamp(num_trials / 4, kFirstLook, kMaxBatch), check.limits.Max(budget));
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

CheckDecision::CheckDecision(const Check& check, const CheckRun& run) : check_(check), run_(run) {
  result_.not_possible = check.not_possible;
  is_done_ = !check.not_possible.empty();
  if (is_done_) return;
  for (const Target& target : check.targets) tallies_.emplace_back(target);
  next_look_ = NextLook(check, run.budget, 0);
}

void CheckDecision::Add(const Outcome& outcome) {
  if (is_done_) return;
  for (size_t t = 0; t < tallies_.size(); ++t) {
    tallies_[t].Add(check_.targets[t], outcome.at(check_.targets[t].statistic));
  }
  Rate(outcome);
  if (++num_trials_ == next_look_) Look();
}

void CheckDecision::Rate(const Outcome& outcome) {
  if (!check_.difficulty_statistic) return;
  const Target& first = check_.targets.front();
  const double difficulty = outcome.at(*check_.difficulty_statistic), value = outcome.at(first.statistic);
  if (std::isnan(value) || std::isnan(difficulty)) return;
  rated_.push_back({difficulty, value >= 0.0 && value <= first.threshold});
}

void CheckDecision::Look() {
  const bool is_last = num_trials_ == check_.limits.Max(run_.budget);
  result_.num_trials = num_trials_;
  result_.targets.clear();
  std::vector<std::optional<Verdict>> verdicts;
  for (size_t t = 0; t < tallies_.size(); ++t) {
    result_.targets.push_back(LookAt(check_.targets[t], tallies_[t], num_trials_, run_.confidence, is_last));
    verdicts.push_back(result_.targets.back().verdict);
  }
  result_.verdict = Together(verdicts);
  const bool is_decided = CanEndEarly(check_) && result_.verdict && *result_.verdict != Verdict::kUndecided;
  is_done_ = is_last || (is_decided && num_trials_ >= check_.limits.min);
  if (IsSilent()) {
    result_.targets.clear();
    result_.not_possible = fmt::format("{} in {} trials", check_.not_stated, num_trials_);
    is_done_ = true;
  }
  next_look_ = NextLook(check_, run_.budget, num_trials_);
}

bool CheckDecision::IsSilent() const {
  if (num_trials_ < kMostSilentTrials) return false;
  bool is_claimed = false;
  for (size_t t = 0; t < check_.targets.size(); ++t) {
    if (!check_.targets[t].IsClaimed()) continue;
    if (!check_.targets[t].is_if_stated || result_.targets[t].n > 0) return false;
    is_claimed = true;
  }
  return is_claimed;
}

std::vector<DifficultyFifth> CheckDecision::Fifths() const {
  constexpr size_t kParts = 5;
  std::vector<RatedTrial> trials = rated_;
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
                      ConfidenceSequence(num_covered, n, run_.confidence), n});
  }
  return fifths;
}

CheckResult CheckDecision::Result() const {
  CheckResult result = result_;
  result.fifths = Fifths();
  return result;
}

CheckResult DecideCheck(const Check& check, const CheckRun& run) {
  CheckDecision decision(check, run);
  while (!decision.IsDone()) {
    const std::int64_t begin = decision.num_trials();
    for (const Outcome& outcome : RunTrials(check, run, begin, NextLook(check, run.budget, begin)))
      decision.Add(outcome);
  }
  return decision.Result();
}

}  // namespace rcme
