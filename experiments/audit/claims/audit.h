// The claim audit: every claim decided, with an error rate for the whole.
#pragma once

#include <compare>
#include <string>
#include <vector>

#include "experiments/audit/claims/decide_check.h"

namespace rcme {

struct AuditOptions {
  std::vector<std::string> only;  // ids or their beginnings ("inlier", "sigma_p.theta"); empty: all
  Budget budget = Budget::kQuick;
  std::uint64_t seed = 1;
  int num_threads = 0;         // 0: one per core; the results do not depend on it
  std::string study;           // name of the study that the claims are made on; empty: the built-in scenes
  std::string study_identity;  // as in StudyPlan
  Settings conditions;         // of all checks, where they do not say else
};

struct Audit {
  AuditOptions options;
  int num_targets = 0;      // claimed targets of all claims, whether they were run or not
  double confidence = 0.0;  // of each target's interval
  std::vector<Claim> claims;
  std::vector<ClaimResult> results;  // as claims; of a plan without trials
};

// The probability of any false verdict in an audit of all claims: a claimed number outside its allowed range
// called "holds", or one inside called "does not hold".
inline constexpr double kAuditErrorRate = 0.05;

// The claims of `all` that `only` names. Throws InputError for a name that fits none.
std::vector<Claim> SelectClaims(const std::vector<Claim>& all, const std::vector<std::string>& only);

// The selected claims of `all` and the confidence of their targets: what can be said before any trial.
Audit PlanAudit(const std::vector<Claim>& all, const AuditOptions& options);

// A check of an audit: indices into Audit::claims and into the claim's checks.
struct CheckPlace {
  size_t claim = 0, check = 0;
  auto operator<=>(const CheckPlace&) const = default;
};

// All of them in their order.
std::vector<CheckPlace> ListCheckPlaces(const Audit& plan);

const Check& CheckAt(const Audit& plan, const CheckPlace& place);
CheckRun MakeCheckRun(const Audit& plan, const CheckPlace& place);

// The verdicts of the claims from those of their checks, of which there is one in audit->results for each.
void JudgeClaims(Audit* audit);

// For each of ListCheckPlaces the seconds on the audit's threads that the check takes if no verdict stops it.
std::vector<double> EstimateSeconds(const Audit& plan);

}  // namespace rcme
