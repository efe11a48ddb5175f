#include "experiments/run/run_until.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/core/text/key_value.h"
#include "experiments/core/text/message.h"
#include "experiments/data/make_data.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "stats/confidence_sequence.h"

namespace rcme {
namespace {

constexpr std::int64_t kFirstLook = 100;

std::int64_t NextLook(std::int64_t num_trials) { return num_trials + num_trials / 2; }

// The half width relative to the allowed one: at most 1 if the target is reached.
double Excess(const PrecisionTarget& target, double rate, const Interval& interval) {
  const double half_width = 0.5 * (interval.upper - interval.lower);
  const double allowed =
      target.kind == PrecisionTarget::Kind::kHalfWidth ? target.value : target.value * rate;
  return half_width / allowed;  // infinite for a relative target before the first event
}

// Evaluates exactly the first `num_trials` trials of the condition. An interrupted run may have more.
CellPrecision Look(const StudyPlan& plan, const Condition& condition, std::int64_t num_trials,
                   const UntilOptions& options, const ResultStore& store) {
  std::vector<std::int64_t> num_events(plan.estimators.size(), 0);
  std::int64_t num_simulated = 0;
  store.ForEachTrial(
      [&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
        if (problem.trial >= num_trials) return;
        if (problem.weight != 1.0)
          throw InputError(
              "--until: the trials of this study are weighted (tilted_to); give --trials instead");
        if (!IsCounted(records.front())) return;
        ++num_simulated;
        for (size_t e = 0; e < records.size(); ++e) {
          if (options.event.needs_truth && !IsScored(records[e])) {
            throw InputError("--until: the truth of this study's pairs is not known; give --trials instead");
          }
          num_events[e] += options.event.has_happened(records[e], plan.study.failure);
        }
      },
      condition.index);
  CellPrecision worst;
  worst.condition = condition.index;
  worst.num_trials = num_trials;
  double worst_excess = -1.0;
  if (num_simulated == 0) num_events.clear();  // more trials would not help
  for (size_t e = 0; e < num_events.size(); ++e) {
    const double rate = static_cast<double>(num_events[e]) / static_cast<double>(num_simulated);
    const Interval interval = ConfidenceSequence(num_events[e], num_simulated);
    const double excess = Excess(options.target, rate, interval);
    if (excess <= worst_excess) continue;
    worst_excess = excess;
    worst.estimator = e;
    worst.rate = rate;
    worst.interval = interval;
  }
  worst.is_reached = worst_excess <= 1.0;
  return worst;
}

}  // namespace

PrecisionTarget PrecisionTarget::Parse(const std::string& text) {
  PrecisionTarget target;
  const auto [name, value, has_equals] = SplitKeyValue(text);
  const bool is_number = ParseReal(value, &target.value) && target.value > 0.0;
  target.kind = name == "rel" ? Kind::kRelative : Kind::kHalfWidth;
  if ((name != "ci" && name != "rel") || !is_number || target.value > 1.0 || target.value < 1e-6) {
    throw InputError(
        fmt::format("--until: '{}' is not allowed; give ci=W (half width of the 95 % interval, as a rate) or "
                    "rel=S (half width "
                    "as a share of the rate), a number in [1e-6, 1]",
                    text));
  }
  return target;
}

void CheckTrialsAreNew(const StudyPlan& plan) {
  if (plan.study.repeats_per_scene > 1) {
    throw InputError(
        "--until: repeats of a scene (repeats_per_scene) are not independent, as its intervals require; "
        "give --trials instead");
  }
  if (FindSetting(plan.study.data, "scene") == kMatchFilesScene) {
    throw InputError(
        "--until: the trials of match files repeat the same pairs with other random numbers, so that they are not "
        "independent, as its intervals require; give --trials instead");
  }
}

namespace {

void Begin(const StudyPlan& plan, ResultStore* store) {
  CheckTrialsAreNew(plan);
  store->NoteStoppingRule(kUntilRule);
}

std::vector<std::uint32_t> AllConditions(const StudyPlan& plan) {
  std::vector<std::uint32_t> all;
  for (const Condition& condition : plan.conditions) all.push_back(condition.index);
  return all;
}

StudyPlan WithoutTrials(StudyPlan plan) {
  for (Condition& condition : plan.conditions) condition.num_trials = 0;
  return plan;
}

// Sets the number of trials of every open condition.
void Grow(const std::vector<std::uint32_t>& open, std::int64_t num_trials, StudyPlan* growing) {
  for (const std::uint32_t c : open) growing->conditions[c].num_trials = static_cast<int>(num_trials);
  PrintMessage("{} of {} conditions to {} trials each\n", open.size(), growing->conditions.size(),
               num_trials);
}

}  // namespace

bool RunRoundUntil(const StudyPlan& plan, const UntilOptions& options, const Shard& shard,
                   ResultStore* merged, ResultStore* store) {
  Begin(plan, store);
  std::vector<std::uint32_t> open = AllConditions(plan);
  StudyPlan growing = WithoutTrials(plan);
  for (std::int64_t look = kFirstLook; !open.empty(); look = NextLook(look)) {
    const std::int64_t num_trials = std::min(look, options.max_trials);
    const auto is_complete = [&](std::uint32_t c) {
      return merged && merged->MissingTrials(c, static_cast<std::uint32_t>(num_trials)).empty();
    };
    if (!std::ranges::all_of(open, is_complete)) {
      Grow(open, num_trials, &growing);
      RunStudy(growing, options.num_threads, store, shard);
      return true;
    }
    std::erase_if(open, [&](std::uint32_t c) {
      return num_trials == options.max_trials ||
             Look(growing, growing.conditions[c], num_trials, options, *merged).is_reached;
    });
  }
  return false;
}

std::vector<CellPrecision> RunUntil(const StudyPlan& plan, const UntilOptions& options, ResultStore* store) {
  Begin(plan, store);
  std::vector<CellPrecision> cells(plan.conditions.size());
  std::vector<std::uint32_t> open = AllConditions(plan);
  StudyPlan growing = WithoutTrials(plan);
  for (std::int64_t look = kFirstLook; !open.empty(); look = NextLook(look)) {
    const std::int64_t num_trials = std::min(look, options.max_trials);
    Grow(open, num_trials, &growing);
    RunStudy(growing, options.num_threads, store);
    for (const std::uint32_t c : open)
      cells[c] = Look(growing, growing.conditions[c], num_trials, options, *store);
    std::erase_if(open,
                  [&](std::uint32_t c) { return cells[c].is_reached || num_trials == options.max_trials; });
  }
  return cells;
}

}  // namespace rcme
