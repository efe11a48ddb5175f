// The sentences of a conform report and of a conform file.
#pragma once

#include <string>
#include <vector>

#include "experiments/conform/conform_report.h"

namespace rcme {

// Sentences: the rule's promises, their scope, and what could not be promised.
std::vector<std::string> DescribePromises(const ConformRule& rule);

// Paragraphs: the numbers of answers and groups that a promise needs.
std::string DescribeNeeds(const ConformPromise& promise);

// The findings on promises and shift.
std::string DescribeConformFindings(const ConformReport& report);

// Says whose answers were judged by which rule.
std::string DescribeJudgedAnswers(const ConformReport& report);

// Says what the error of the truth does; empty where every truth is exact.
std::string DescribeConformTruth(const ConformReport& report);

// Explains the columns of the tables, and what the intervals of a cross-validation estimate
// (cross_validate.h).
std::string DescribeConformColumns(const ConformReport& report);

}  // namespace rcme
