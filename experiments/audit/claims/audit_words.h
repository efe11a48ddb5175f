// Phrases that the tables, the page and the JSON document of an audit share.
#pragma once

#include <optional>
#include <string>

#include "experiments/audit/claims/audit.h"
#include "experiments/core/table/table.h"

namespace rcme {

inline const NumberFormat kFourDigits{1.0, "", ".4g"};

const char* BudgetName(Budget budget);
bool IsOnStudy(const Audit& audit);

// Describes the probability of a false verdict.
std::string DescribeErrors(const Audit& audit);

// "holds" etc.; "measured" if nothing is claimed.
const char* VerdictName(const std::optional<Verdict>& verdict);

// In which way the regions of a check or a claim fail.
std::optional<Side> FindSide(const Check& check, const CheckResult& result);
std::optional<Side> FindSide(const Claim& claim, const ClaimResult& result);
// Empty for nullopt.
std::string SideName(const std::optional<Side>& side);
// "does not hold: too narrow"
std::string AddSide(const std::string& verdict, const std::optional<Side>& side);

std::string DescribeVerdict(const Claim& claim, const ClaimResult& result);
std::string DescribeVerdict(const Check& check, const CheckResult& result);
// "key = value, key = value"
std::string DescribeConditions(const Check& check);
// "0.95 in [0.94, 0.96]"
std::string DescribeClaimed(const Target& target);
// What the target can decide at the audit's budget; "-" if nothing is claimed.
std::string DescribePower(const Audit& audit, const Check& check, const Target& target);
// n, and the number of trials if some of them contribute nothing to the target.
std::string DescribeTrials(const TargetResult& target, const CheckResult& check);

// Whether to leave out a target about which no answer states anything.
bool IsLeftOut(const Target& target, const TargetResult& result);

}  // namespace rcme
