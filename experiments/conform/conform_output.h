#pragma once

#include <string>
#include <vector>

#include "experiments/conform/conform_report.h"
#include "experiments/core/table/command_result.h"

namespace rcme {

// Sentences: what the rule promises, what for, and what it needs for more.
std::vector<std::string> DescribePromises(const ConformRule& rule);

// How many answers and groups a promise needs.
std::string DescribeNeeds(const ConformPromise& promise);

// `by_strata`: also by what is visible of an answer (conform_strata.h).
std::string ConformAsText(const ConformReport& report, bool by_strata = false);
std::string ConformAsJson(const ConformReport& report, bool by_strata = false);

CommandResult MakeConformResult(const ConformReport& report, bool by_strata = false);

}  // namespace rcme
