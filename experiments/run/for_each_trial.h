// Runs the same trial numbers of every condition of a plan.
#pragma once

#include <cstdint>
#include <functional>

#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_range.h"

namespace rcme {

// `index` counts from 0; each condition has `trials.end - trials.first` consecutive indices.
using TrialWork = std::function<void(const Condition& condition, std::uint32_t trial, std::int64_t index)>;

// Calls `work` for each trial. With one thread, the order is that of the plan. With several (`num_threads`;
// 0: one per core), all conditions take turns, because the first trial of a condition searches its baseline
// while the condition's other trials wait. A stop request ends it with Stopped.
void ForEachTrial(const StudyPlan& plan, TrialRange trials, const TrialWork& work, int num_threads = 1);

}  // namespace rcme
