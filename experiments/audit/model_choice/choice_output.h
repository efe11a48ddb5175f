#pragma once

#include "experiments/audit/model_choice/choice_counts.h"
#include "experiments/core/table/command_result.h"

namespace rcme {

// On the screen there is one matrix per group and criterion, with one row for each truth that occurs, and
// rates with exact 95 % intervals. Files have the rows of `rcme summarize --format csv`, so that the same
// figures can draw them: truth and verdict are factors besides the chosen ones, a criterion takes the place
// of an estimator, the quantity is `share`, and there is a further column, `count`. A truth without trials is
// included with n = 0.
CommandResult MakeChoiceResult(const StudyPlan& plan, const ChoiceCounts& counts);

}  // namespace rcme
