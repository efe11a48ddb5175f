#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/tuning/transfer.h"

namespace rcme {

// For people what each family is tuned to, and on how many of the others the target holds; in files every
// cell of the matrix.
CommandResult MakeTransferResult(const StudyPlan& plan, const SettingPlan& settings,
                                 const TransferResult& result);

}  // namespace rcme
