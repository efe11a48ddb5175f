#include "experiments/statistics/scene_split.h"

#include <cmath>

#include "experiments/trial/trial_event.h"

namespace rcme {
namespace {

constexpr const char* kBetween = "_between_scenes";
constexpr const char* kWithin = "_within_scenes";
constexpr const char* kFlips = "_flips";

SummaryRow MakeSplitRow(const SummaryRow& cell, const std::string& quantity, SummaryRow::Kind kind) {
  SummaryRow row = cell;
  row.quantity = quantity;
  row.kind = kind;
  return row;
}

}  // namespace

SceneSplit::SceneSplit(int repeats_per_scene)
    : repeats_per_scene_(repeats_per_scene),
      counts_(TrialEvents().size(), Counts{0, 0, RepeatedEvents(repeats_per_scene)}) {}

void SceneSplit::Add(const TrialRecord& record, const FailureBounds& bounds) {
  for (size_t v = 0; v < counts_.size(); ++v) {
    const TrialEvent& event = TrialEvents()[v];
    if (!event.IsKnownFor(record)) continue;
    ++counts_[v].num_trials;
    counts_[v].num_events += event.has_happened(record, bounds);
  }
}

void SceneSplit::EndScene() {
  for (Counts& counts : counts_) {
    if (counts.num_trials == repeats_per_scene_) counts.scenes.AddScene(counts.num_events);
    counts.num_trials = counts.num_events = 0;
  }
}

void SceneSplit::AppendRows(const SummaryRow& cell, std::vector<SummaryRow>* rows) const {
  for (size_t v = 0; v < counts_.size(); ++v) {
    const std::string& event = TrialEvents()[v].name;
    const VarianceSplit split = counts_[v].scenes.Split();
    SummaryRow within = MakeSplitRow(cell, event + kWithin, SummaryRow::Kind::kVarianceShare);
    within.is_of_split = true;
    within.n = std::isnan(split.within_share) ? 0 : split.num_scenes;  // NaN: nothing varies
    within.value = split.within_share;
    within.interval = split.within_share_interval;
    within.interval_kind = IntervalKind::kLogStudent;
    SummaryRow between = within;
    between.quantity = event + kBetween;
    between.value = 1.0 - within.value;
    between.interval = {1.0 - within.interval.upper, 1.0 - within.interval.lower};
    SummaryRow flips = MakeSplitRow(cell, event + kFlips, SummaryRow::Kind::kRate);
    flips.is_of_split = true;
    flips.n = split.num_scenes;
    flips.value = static_cast<double>(split.num_mixed) / static_cast<double>(split.num_scenes);
    flips.interval = split.mixed_interval;
    flips.interval_kind = IntervalKind::kExact;
    rows->insert(rows->end(), {between, within, flips});
  }
}

std::vector<QuantityHelp> SceneSplitQuantities() {
  std::vector<QuantityHelp> help;
  const std::string kind = KindName(SummaryRow::Kind::kVarianceShare);
  const std::string base = "repeated scenes";
  for (const TrialEvent& event : TrialEvents()) {
    const std::string share = "variance of " + event.name;
    help.push_back({event.name + kBetween, kind, share + " between scenes", base});
    help.push_back({event.name + kWithin, kind, share + " within scenes, from the sampler", base});
    help.push_back({event.name + kFlips, KindName(SummaryRow::Kind::kRate),
                    event.name + " depends on the sampler's seed", base});
  }
  return help;
}

}  // namespace rcme
