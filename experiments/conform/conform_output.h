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

std::string ConformAsText(const ConformReport& report);
std::string ConformAsJson(const ConformReport& report);

CommandResult MakeConformResult(const ConformReport& report);

}  // namespace rcme
