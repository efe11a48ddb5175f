#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/tuning/transfer.h"

namespace rcme {

// For people: what each family is tuned to, and on how many of the others the target holds.
std::string TransferAsTable(const StudyPlan& plan, const TransferResult& result);
// For plots/transfer.py: every cell of the matrix.
std::string TransferAsJson(const StudyPlan& plan, const SettingPlan& settings, const TransferResult& result);

CommandResult MakeTransferResult(const StudyPlan& plan, const SettingPlan& settings,
                                 const TransferResult& result);

}  // namespace rcme
