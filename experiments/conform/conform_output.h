#pragma once

#include <string>

#include "experiments/conform/conform_report.h"
#include "experiments/core/table/command_result.h"

namespace rcme {

// `by_strata`: with coverage and size by visible strata (conform_strata.h).
std::string ConformAsText(const ConformReport& report, bool by_strata = false);
std::string ConformAsJson(const ConformReport& report, bool by_strata = false);

CommandResult MakeConformResult(const ConformReport& report, bool by_strata = false);

}  // namespace rcme
