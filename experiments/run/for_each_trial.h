// The one way to run many trials of a plan: by threads, with progress, until a request to stop.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "experiments/core/work/progress.h"
#include "experiments/core/work/shard.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_range.h"

namespace rcme {

struct TrialsOfCondition {
  const Condition* condition = nullptr;  // lives as long as its plan
  TrialRange trials;                     // by their place in the shard
  ShardTrials shard = {};                // has all trials, unless it is given
};

// The same trials of every condition, in the plan's order.
std::vector<TrialsOfCondition> TrialsOfEach(const StudyPlan& plan, TrialRange trials);

std::int64_t NumTrials(const std::vector<TrialsOfCondition>& trials);

// `index` counts the trials from 0 in the order of the list, whatever order they are run in.
using TrialWork = std::function<void(const Condition& condition, std::uint32_t trial, std::int64_t index)>;

// Calls `work` for each of the trials, once, on `num_threads` threads (0: one per core), and advances
// `progress`, if there is one, by one after each. The first exception ends it and is thrown on; so does a
// request to stop, as Stopped.
void ForEachTrial(const std::vector<TrialsOfCondition>& trials, int num_threads, Progress* progress,
                  const TrialWork& work);

}  // namespace rcme
