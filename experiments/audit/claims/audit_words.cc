#include "experiments/audit/claims/audit_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/audit/claims/power.h"

namespace rcme {

const char* BudgetName(Budget budget) { return budget == Budget::kQuick ? "quick" : "full"; }

const char* VerdictName(const std::optional<Verdict>& verdict) {
  return verdict ? Name(*verdict) : Name(ClaimVerdict::kMeasured);
}

std::string DescribeConditions(const Check& check) {
  std::string words;
  for (const auto& [key, value] : check.conditions) {
    words += fmt::format("{}{} = {}", words.empty() ? "" : ", ", key, value);
  }
  return words;
}

std::string DescribeClaimed(const Target& target) {
  if (!target.IsClaimed()) return "-";
  return fmt::format("{:.4g} in [{:.4g}, {:.4g}]", target.nominal, target.allowed.lower,
                     target.allowed.upper);
}

std::string DescribePower(const Audit& audit, const Check& check, const Target& target) {
  if (!target.IsClaimed()) return "-";
  return DescribeFound(FindPower(target, check.limits.Max(audit.options.budget), audit.confidence));
}

std::optional<Side> FindSide(const Check& check, const CheckResult& result) {
  std::vector<std::optional<Side>> sides;
  for (size_t t = 0; t < result.targets.size(); ++t)
    sides.push_back(FindFailedSide(check.targets[t], result.targets[t]));
  return JoinSides(sides);
}

std::optional<Side> FindSide(const Claim& claim, const ClaimResult& result) {
  std::vector<std::optional<Side>> sides;
  for (size_t c = 0; c < claim.checks.size(); ++c)
    sides.push_back(FindSide(claim.checks[c], result.checks[c]));
  return JoinSides(sides);
}

std::string SideName(const std::optional<Side>& side) { return side ? Name(*side) : ""; }

std::string AddSide(const std::string& verdict, const std::optional<Side>& side) {
  return side ? fmt::format("{}: {}", verdict, Name(*side)) : verdict;
}

std::string DescribeVerdict(const Claim& claim, const ClaimResult& result) {
  std::string words = Name(result.verdict);
  if (result.verdict == ClaimVerdict::kSmallNoiseOnly) {
    return fmt::format("{} (up to {} px)", words, *result.holds_up_to_sigma_px);
  }
  if (result.verdict == ClaimVerdict::kDoesNotHold) words = AddSide(words, FindSide(claim, result));
  const auto num_impossible = std::ranges::count_if(
      result.checks, [](const CheckResult& check) { return !check.not_possible.empty(); });
  if (num_impossible == 0 || result.verdict == ClaimVerdict::kNotPossible) return words;
  return fmt::format("{} (not possible in {} of {} conditions)", words, num_impossible, claim.checks.size());
}

std::string DescribeVerdict(const Check& check, const CheckResult& result) {
  if (!result.not_possible.empty()) return Name(ClaimVerdict::kNotPossible);
  return AddSide(VerdictName(result.verdict), FindSide(check, result));
}

bool IsLeftOut(const Target& target, const TargetResult& result) {
  return target.is_if_stated && result.n == 0;
}

std::string DescribeTrials(const TargetResult& target, const CheckResult& check) {
  return target.n == check.num_trials ? fmt::format("{}", target.n)
                                      : fmt::format("{} of {}", target.n, check.num_trials);
}

std::string DescribeErrors(const Audit& audit) {
  return fmt::format(
      "Intervals hold at all sample sizes at once, each with confidence 1 - {:.2g}; the probability of any "
      "false verdict among all {} claimed numbers is at most {}.",
      1.0 - audit.confidence, audit.num_targets, kAuditErrorRate);
}

bool IsOnStudy(const Audit& audit) { return !audit.options.study.empty(); }

}  // namespace rcme
