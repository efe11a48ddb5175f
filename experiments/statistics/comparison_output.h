#pragma once

#include "experiments/core/table/command_result.h"
#include "experiments/statistics/compare.h"

namespace rcme {

// For people: a table for each compared quantity, with a row per condition and estimator. In files: a row
// per condition, estimator and quantity, with the columns study, condition, one per factor, estimator,
// reference, event (or score, or error), n, both, estimator_only, reference_only, neither (trials),
// risk_difference (for scores the difference of means, for errors the median in deg), lower, upper,
// p_mcnemar (if that is the test), p_holm, kind (event, score, error), p_value, test, interval. Unknown
// values are empty cells, null in JSON.
CommandResult MakeComparisonResult(const Comparison& comparison);

}  // namespace rcme
