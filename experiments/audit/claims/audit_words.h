// What the tables, the page and the JSON document of an audit say alike.
#pragma once

#include <optional>
#include <string>

#include "experiments/audit/claims/audit.h"
#include "experiments/core/table/table.h"

namespace rcme {

inline const NumberFormat kFourDigits{1.0, "", ".4g"};

const char* BudgetName(Budget budget);
bool IsOnStudy(const Audit& audit);

// The probability of a false verdict.
std::string DescribeErrors(const Audit& audit);

// "holds", "measured" where nothing is claimed.
const char* VerdictName(const std::optional<Verdict>& verdict);

// How the regions of a check or a claim are wrong.
std::optional<Side> FindSide(const Check& check, const CheckResult& result);
std::optional<Side> FindSide(const Claim& claim, const ClaimResult& result);
// Empty: none.
std::string SideName(const std::optional<Side>& side);
// "does not hold: too narrow"
std::string AddSide(const std::string& verdict, const std::optional<Side>& side);

std::string DescribeVerdict(const Claim& claim, const ClaimResult& result);
std::string DescribeVerdict(const Check& check, const CheckResult& result);
// "key = value, key = value"
std::string DescribeConditions(const Check& check);
// "0.95 in [0.94, 0.96]"
std::string DescribeClaimed(const Target& target);
// What the target can decide at the audit's budget; "-" where nothing is claimed.
std::string DescribePower(const Audit& audit, const Check& check, const Target& target);
// n, and of how many trials where not all of them say something of the target.
std::string DescribeTrials(const TargetResult& target, const CheckResult& check);

// A target of which no answer states anything is in no output.
bool IsLeftOut(const Target& target, const TargetResult& result);

}  // namespace rcme
