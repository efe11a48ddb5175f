// Divides the trials of a plan into work for the runner (core/work/runner.h): a group per condition, whose
// items are blocks of `trials_of_item` trials.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "experiments/core/work/runner.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_range.h"

namespace rcme {

// `identity`: lines for whatever else the results depend on; they and the number of trials precede the
// identity of the plan.
WorkPlan PlanTrialItems(const StudyPlan& plan, const std::string& work, std::uint32_t trials_of_item,
                        const std::string& identity = "");

TrialRange FindTrialsOfItem(const StudyPlan& plan, const ItemPlace& place, std::uint32_t trials_of_item);

// Computes the items of the runner's shard. Progress counts trials.
using ComputeTrials = std::function<std::string(const Condition& condition, const TrialRange& trials)>;
void GetTrialItems(const StudyPlan& plan, std::uint32_t trials_of_item, const ComputeTrials& compute,
                   Runner* runner);

// Throws InputError that begins with `command` if the trials have weights (tilted_to).
void RequireUnweighted(const StudyPlan& plan, const std::string& command);

}  // namespace rcme
