#pragma once

#include "experiments/core/table/command_result.h"
#include "experiments/tuning/transfer.h"

namespace rcme {

// The result of a transfer. The screen shows the setting of each family, and on how many of the others the
// target holds; files hold every cell of the matrix.
CommandResult MakeTransferResult(const StudyPlan& plan, const SettingPlan& settings,
                                 const TransferResult& result);

}  // namespace rcme
