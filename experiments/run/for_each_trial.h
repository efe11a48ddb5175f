// The same trials of every condition of a plan.
#pragma once

#include <cstdint>
#include <functional>

#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_range.h"

namespace rcme {

// `index` counts from 0; `trials.end - trials.first` of them are of each condition.
using TrialWork = std::function<void(const Condition& condition, std::uint32_t trial, std::int64_t index)>;

// Calls `work` for each, in the plan's order where there is one thread, as inside an item of long work; from
// several at once where `num_threads` (0: one per core) is another number: then one trial of every condition
// after the other, as the first trial of a condition finds its baseline, which its others wait for. A request
// to stop ends it, as Stopped.
void ForEachTrial(const StudyPlan& plan, TrialRange trials, const TrialWork& work, int num_threads = 1);

}  // namespace rcme
