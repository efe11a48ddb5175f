// The trials of a plan as work for the runner (core/work/runner.h): a group per condition, whose items are
// blocks of as many trials.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "experiments/core/work/runner.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_range.h"

namespace rcme {

// `identity`: what the results depend on beside the plan, lines that come before those of the plan.
WorkPlan PlanTrialItems(const StudyPlan& plan, const std::string& work, std::uint32_t trials_of_item,
                        const std::string& identity = "");

TrialRange FindTrialsOfItem(const StudyPlan& plan, const ItemPlace& place, std::uint32_t trials_of_item);

// Those of the runner's shard; progress counts trials.
using ComputeTrials = std::function<std::string(const Condition& condition, const TrialRange& trials)>;
void GetTrialItems(const StudyPlan& plan, std::uint32_t trials_of_item, const ComputeTrials& compute,
                   Runner* runner);

// Throws InputError that begins with `command`, for trials with weights (tilted_to).
void RequireUnweighted(const StudyPlan& plan, const std::string& command);

}  // namespace rcme
