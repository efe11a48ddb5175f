#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/statistics/compare.h"

namespace rcme {

// For people a table per thing compared, one row per condition and estimator. In files one row per condition,
// estimator and thing compared, the columns study, condition, one per factor, estimator, reference, event (or
// score, or error), n, both, estimator_only, reference_only, neither (trials), risk_difference (of scores
// that of means, of errors the median in deg), lower, upper, p_mcnemar (where that is the test), p_holm, kind
// (event, score, error), p_value, test, interval. Empty cells: unknown; in JSON null.
CommandResult MakeComparisonResult(const Comparison& comparison);

}  // namespace rcme
