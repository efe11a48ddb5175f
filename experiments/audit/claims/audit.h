// The claim audit: decides every claim, with an error rate for all verdicts together.
#pragma once

#include <compare>
#include <string>
#include <vector>

#include "experiments/audit/claims/decide_check.h"

namespace rcme {

struct AuditOptions {
  // ids of claims, or their beginnings ("inlier", "sigma_p.theta"); empty: all
  std::vector<std::string> only;  // ids or their beginnings ("inlier", "sigma_p.theta"); empty: all
  Budget budget = Budget::kQuick;
  std::uint64_t seed = 1;
  int num_threads = 0;         // 0: one per core; the results do not depend on it
  std::string study;           // name of the study on which the claims are made; empty: the built-in scenes
  std::string study_identity;  // as in StudyPlan
  Settings conditions;         // of all checks, unless a check sets its own
};

struct Audit {
  AuditOptions options;
  int num_targets = 0;      // claimed targets of all claims, selected or not
  double confidence = 0.0;  // of each target's interval
  std::vector<Claim> claims;
  std::vector<ClaimResult> results;  // one per claim; without trials in a plan
};

// The probability of at least one false verdict in an audit of all claims. A verdict is false if a claimed
// number outside its allowed range is called "holds", or one inside is called "does not hold".
inline constexpr double kAuditErrorRate = 0.05;

// The claims of `all` that `only` names. Throws InputError for a name that matches none.
std::vector<Claim> SelectClaims(const std::vector<Claim>& all, const std::vector<std::string>& only);

// The selected claims of `all` and the confidence of their targets, before any trial.
Audit PlanAudit(const std::vector<Claim>& all, const AuditOptions& options);

// A check of an audit: indices into Audit::claims and into the claim's checks.
struct CheckPlace {
  size_t claim = 0, check = 0;
  auto operator<=>(const CheckPlace&) const = default;
};

// All checks in their order.
std::vector<CheckPlace> ListCheckPlaces(const Audit& plan);

const Check& CheckAt(const Audit& plan, const CheckPlace& place);
CheckRun MakeCheckRun(const Audit& plan, const CheckPlace& place);

// Computes the verdicts of the claims from those of their checks, which audit->results already holds.
void JudgeClaims(Audit* audit);

// For each check of ListCheckPlaces, the seconds on the audit's threads if no verdict ends it early.
std::vector<double> EstimateSeconds(const Audit& plan);

}  // namespace rcme
