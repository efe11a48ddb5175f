// The trials inside one item of long work, one after the other.
#pragma once

#include <cstdint>
#include <functional>

#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_range.h"

namespace rcme {

// `index` counts from 0; `trials.end - trials.first` of them are of each condition.
using TrialWork = std::function<void(const Condition& condition, std::uint32_t trial, std::int64_t index)>;

// Calls `work` for the same trials of every condition, in the plan's order. A request to stop ends it, as
// Stopped.
void ForEachTrial(const StudyPlan& plan, TrialRange trials, const TrialWork& work);

}  // namespace rcme
