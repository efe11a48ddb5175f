#pragma once

#include <string>
#include <vector>

#include "experiments/conform/conform_report.h"
#include "experiments/core/table/command_result.h"

namespace rcme {

// Sentences: the rule's promises, their scope, and what could not be promised.
std::vector<std::string> DescribePromises(const ConformRule& rule);

// Paragraphs: the numbers of answers and groups that a promise needs.
std::string DescribeNeeds(const ConformPromise& promise);

// `by_strata`: with coverage and size by visible strata (conform_strata.h).
std::string ConformAsText(const ConformReport& report, bool by_strata = false);
std::string ConformAsJson(const ConformReport& report, bool by_strata = false);

CommandResult MakeConformResult(const ConformReport& report, bool by_strata = false);

}  // namespace rcme
