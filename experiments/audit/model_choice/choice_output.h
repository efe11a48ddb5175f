#pragma once

#include <string>

#include "experiments/audit/model_choice/choice_counts.h"
#include "experiments/core/table/command_result.h"

namespace rcme {

// For people a matrix per group and criterion, a row for each truth that there is, rates with exact 95 %
// intervals. In files rows of `rcme summarize --format csv`, so that the same figures draw it: truth and
// verdict are factors beside the chosen ones, a criterion stands in the place of an estimator, the quantity
// is `share`; one more column, `count`. A truth that no trial has is there with n = 0.
CommandResult MakeChoiceResult(const StudyPlan& plan, const ChoiceCounts& counts);

}  // namespace rcme
