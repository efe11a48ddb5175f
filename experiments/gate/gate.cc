#include "experiments/gate/gate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/core/text/pick_name.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/trial/trial_event.h"
#include "parameters/input_error.h"
#include "stats/constants.h"
#include "stats/moments.h"
#include "stats/multiple_testing.h"
#include "stats/score_mean.h"
#include "stats/stream_median.h"

namespace rcme {
namespace {

constexpr std::int64_t kTrialsOfFirstLook = 200, kLeastRounds = 20;

// Collects the numbers of a run's trials for one test.
class GateEvidence {
 public:
  explicit GateEvidence(const GateTest& test)
      : test_(test), differences_(test.is_limit ? Interval{0.0, 1.0} : Interval{-1.0, 1.0}) {}

  // `scene`: its number from 0 if trials share scenes, else negative.
  void Add(const std::optional<double>& of_old, const std::optional<double>& of_new, std::int64_t scene) {
    if (!of_new || (!of_old && !test_.is_limit)) return;
    if (of_old) old_.Add(*of_old);
    new_.Add(*of_new);
    const double difference = test_.is_limit ? *of_new : test_.quantity.Difference(*of_new, *of_old);
    if (scene < 0) return differences_.Add(difference);
    if (std::ssize(scenes_) <= scene) scenes_.resize(static_cast<size_t>(scene) + 1);
    scenes_[static_cast<size_t>(scene)].Add(difference);
  }

  // Adds the growth from the old to the new region of a pair.
  void AddSizes(const TrialRecord& of_old, const TrialRecord& of_new) {
    if (!test_.quantity.log_size) return;
    const double growth = test_.quantity.log_size(of_new) - test_.quantity.log_size(of_old);
    if (std::isfinite(growth)) log_growth_.Add(growth);
  }

  GateRow Finish() {
    for (SceneMean& scene : scenes_) {
      if (const std::optional<double> mean = scene.Take()) differences_.Add(*mean);
    }
    GateRow row;
    row.test = test_;
    row.n = differences_.n();
    row.of_old = Level(old_);
    row.of_new = Level(new_);
    if (log_growth_.n() > 0) row.size_ratio = std::exp(log_growth_.mean());
    if (row.n == 0) {
      row.verdict = GateVerdict::kNotMeasured;
      row.difference = kNaN;
      row.interval = {kNaN, kNaN};
      return row;
    }
    const GateQuantity& quantity = test_.quantity;
    const Interval interval = differences_.Sequence(1.0 - 2.0 * kGateLevel);
    const double margin = quantity.ToDifference(test_.margin);
    row.difference = quantity.FromDifference(differences_.mean());
    row.interval = {quantity.FromDifference(interval.lower), quantity.FromDifference(interval.upper)};
    row.p_worse = differences_.PValueOfAtMost(margin);
    row.p_not_worse = differences_.PValueOfAtLeast(margin);
    return row;
  }

 private:
  struct Numbers {
    void Add(double x) { sum += x, median.Add(x); }
    double sum = 0.0;
    StreamMedian median;
  };

  double Level(const Numbers& numbers) const {
    const std::int64_t n = numbers.median.n();
    if (n == 0) return kNaN;
    return test_.quantity.scale == GateScale::kRatio ? numbers.median.median()
                                                     : numbers.sum / static_cast<double>(n);
  }

  GateTest test_;
  Numbers old_, new_;  // the numbers of the pairs
  ScoreMean differences_;
  Moments log_growth_;
  std::vector<SceneMean> scenes_;
};

// Numbers the scenes of a run if trials share them: repeats of a scene, or scenes common to all conditions.
class SceneNumbers {
 public:
  SceneNumbers(const RunDescription& run, std::int64_t num_rounds)
      : repeats_(run.repeats_per_scene),
        per_condition_((num_rounds + repeats_ - 1) / repeats_),
        is_common_(HasCommonScenes(run)) {}

  std::int64_t Of(const ProblemRecord& problem) const {
    if (repeats_ == 1 && !is_common_) return -1;
    return problem.trial / repeats_ + (is_common_ ? 0 : problem.condition * per_condition_);
  }

 private:
  std::int64_t repeats_, per_condition_;
  bool is_common_;
};

void Decide(GateLook* look) {
  std::vector<double> p_values;
  for (const GateRow& row : look->rows) p_values.push_back(row.p_worse);
  const std::vector<double> adjusted = HolmAdjusted(p_values);
  bool is_worse = false, is_open = false, is_measured = false;
  for (size_t i = 0; i < look->rows.size(); ++i) {
    GateRow& row = look->rows[i];
    row.p_worse = adjusted[i];
    if (row.verdict == GateVerdict::kNotMeasured) continue;
    is_measured = true;
    row.verdict = row.p_worse <= kGateLevel       ? GateVerdict::kWorse
                  : row.p_not_worse <= kGateLevel ? GateVerdict::kNotWorse
                                                  : GateVerdict::kUndecided;
    is_worse = is_worse || row.verdict == GateVerdict::kWorse;
    is_open = is_open || row.verdict == GateVerdict::kUndecided;
  }
  look->verdict = is_worse                  ? GateVerdict::kWorse
                  : is_open || !is_measured ? GateVerdict::kUndecided
                                            : GateVerdict::kNotWorse;
}

std::int64_t FirstLook(const ReadableRun& run) {
  const std::int64_t num_conditions = std::ssize(run.description.conditions);
  return std::max(kLeastRounds, (kTrialsOfFirstLook + num_conditions - 1) / num_conditions);
}

// A look at 0 trials: every test is undecided.
GateLook BeforeFirstLook(const std::vector<GateTest>& tests) {
  GateLook look;
  for (const GateTest& test : tests) {
    look.rows.push_back(
        {.test = test, .of_old = kNaN, .of_new = kNaN, .difference = kNaN, .interval = {kNaN, kNaN}});
  }
  return look;
}

void RequireMeasured(const GateLook& look) {
  std::vector<std::string> names;
  for (const GateRow& row : look.rows) {
    if (row.n > 0) return;
    names.push_back(row.test.Name());
  }
  throw InputError(
      fmt::format("gate: no trial has {} of both versions; choose other quantities with --of, such as "
                  "failure and refusal",
                  fmt::join(names, " or ")));
}

// Greater is worse.
int RankOutcome(TrialOutcome outcome) {
  return outcome == TrialOutcome::kSuccess ? 0 : outcome == TrialOutcome::kRefusal ? 1 : 2;
}

}  // namespace

std::string Name(GateVerdict verdict) {
  return PickName(verdict, {"not worse", "worse", "undecided", "not measured"});
}

GateLook TakeGateLook(const ReadableRun& run, const std::vector<GateTest>& tests, std::int64_t num_rounds) {
  std::vector<GateEvidence> evidence(tests.begin(), tests.end());
  const SceneNumbers scenes(run.description, num_rounds);
  const FailureBounds& bounds = run.description.failure;
  run.for_each_trial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    if (problem.trial >= num_rounds) return;
    if (problem.weight != 1.0)
      throw InputError("gate: the trials of this study are weighted (tilted_to), so it has no rates of them");
    for (size_t i = 0; i < tests.size(); ++i) {
      std::optional<double> of_old;
      if (records.size() > 1) of_old = tests[i].quantity.of(records.front(), bounds);
      evidence[i].Add(of_old, tests[i].quantity.of(records.back(), bounds), scenes.Of(problem));
      if (records.size() > 1) evidence[i].AddSizes(records.front(), records.back());
    }
  });
  GateLook look{num_rounds, {}, GateVerdict::kUndecided};
  for (GateEvidence& one : evidence) look.rows.push_back(one.Finish());
  Decide(&look);
  return look;
}

GateLook LookUntilDecided(const ReadableRun& run, const std::vector<GateTest>& tests, std::int64_t max_rounds,
                          const GrowRun& grow) {
  GateLook look = BeforeFirstLook(tests);
  for (std::int64_t next = FirstLook(run);; next += std::max<std::int64_t>(1, next / 4)) {
    const std::int64_t num_rounds = std::min(next, max_rounds);
    if (!grow(num_rounds)) return look;
    look = TakeGateLook(run, tests, num_rounds);
    if (num_rounds == max_rounds) RequireMeasured(look);
    if (look.verdict != GateVerdict::kUndecided || num_rounds == max_rounds) return look;
  }
}

std::int64_t CountRounds(const ReadableRun& run) {
  std::vector<std::int64_t> next(run.description.conditions.size(), 0);
  run.for_each_trial([&](const ProblemRecord& problem, const std::vector<TrialRecord>&) {
    next[problem.condition] += problem.trial == next[problem.condition];
  });
  return *std::ranges::min_element(next);
}

std::vector<ChangedTrial> FindChangedTrials(const ReadableRun& run, std::int64_t num_rounds) {
  std::vector<ChangedTrial> changed;
  const FailureBounds& bounds = run.description.failure;
  run.for_each_trial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    if (problem.trial >= num_rounds || records.size() < 2) return;
    const TrialRecord &of_old = records.front(), &of_new = records.back();
    const TrialOutcome before = ClassifyOutcome(of_old, bounds), after = ClassifyOutcome(of_new, bounds);
    if (before == after) return;
    changed.push_back({problem.condition, problem.trial, OutcomeInFull(of_old, bounds),
                       OutcomeInFull(of_new, bounds), RankOutcome(after) > RankOutcome(before)});
  });
  std::ranges::stable_sort(changed, std::greater<>(), &ChangedTrial::is_for_worse);
  return changed;
}

}  // namespace rcme
