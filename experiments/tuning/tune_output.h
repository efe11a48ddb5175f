#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/core/table/table.h"
#include "experiments/tuning/entropy_roc.h"
#include "experiments/tuning/tune.h"
#include "stats/risk_control.h"

namespace rcme {

// A rate of a tuning; NaN if n is 0.
double ComputeRate(const ErrorCount& count);

// The rate with its exact 95 % interval.
Estimate EstimateRate(const ErrorCount& count);

// "1.23 % [1.01, 1.50]"; "-" if n is 0.
std::string RateForTable(const ErrorCount& count);

// {"value", "lower", "upper", "n"}: the rate with its exact 95 % interval; value is null if n is 0.
nlohmann::ordered_json RateAsJson(const ErrorCount& count);

// The question, the tuning and the verification as a table; without a choice, what was tried.
std::string TuneAsTable(const StudyPlan& plan, const TuneResult& result, const std::vector<EntropyRoc>& rocs);

// The table for files, one row per setting: its levels, its rates on the trials for verification, and whether
// it was on the path of the tuning, certified, chosen. Empty if nothing was verified.
Table MakeSettingTable(const StudyPlan& plan, const SettingPlan& settings, const TuneResult& result);

// How often a repeated tuning violated its target, as a table.
std::string RepetitionsAsTable(const StudyPlan& plan, const SettingPlan& settings,
                               const Repetitions& repetitions);

// The origin of the tuned estimator and its measured rates: (key, text) pairs for its file.
std::vector<std::pair<std::string, std::string>> DescribeProvenance(const StudyPlan& plan,
                                                                    const TuneResult& result);

CommandResult MakeRepetitionsResult(const StudyPlan& plan, const SettingPlan& settings,
                                    const Repetitions& repetitions);

}  // namespace rcme
