// The outcomes of every setting of a tuning in the same trials.
#pragma once

#include <vector>

#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_range.h"
#include "experiments/tuning/setting_plan.h"
#include "stats/risk_control.h"

namespace rcme {

// Counts over some trials, of which `n` could be simulated (trial/simulate_draw.h). A trial is good if the
// setting without its limits (SettingPlan) returns a motion within the bounds. A good trial that is refused
// is a false refusal.
struct SettingCount {
  std::int64_t n = 0, failures = 0, refusals = 0, good = 0, false_refusals = 0;

  ErrorCount Failure() const { return {failures, n}; }
  ErrorCount AcceptedFailure() const { return {failures, n - refusals}; }
  ErrorCount Refusal() const { return {refusals, n}; }
  ErrorCount FalseRefusal() const { return {false_refusals, good}; }
  SettingCount& operator+=(const SettingCount& other);
  bool operator==(const SettingCount&) const = default;
};

// [condition][setting].
using SettingCounts = std::vector<std::vector<SettingCount>>;

// Counts the outcomes of the same trials in every condition of the plan. Depends only on the plan, the
// settings and the range. Throws InputError if a condition has weighted trials or no fresh ones (real pairs).
SettingCounts CountOutcomes(const StudyPlan& plan, const SettingPlan& settings, TrialRange trials);

// The sum over some conditions, one per setting.
std::vector<SettingCount> SumOver(const SettingCounts& counts, const std::vector<std::uint32_t>& conditions);

}  // namespace rcme
