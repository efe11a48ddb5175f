#include "experiments/audit/claims/audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "experiments/core/work/for_each_index.h"
#include "parameters/input_error.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

// The condition that names the check's random streams, from the claim's id and the check's number.
std::uint32_t StreamCondition(const std::string& id, size_t check) {
  Fnv1a32 hash;
  hash.Add(fmt::format("{} {}", id, check));
  return hash.value();
}

int CountTargets(const std::vector<Claim>& claims) {
  int count = 0;
  for (const Claim& claim : claims) {
    for (const Check& check : claim.checks) {
      count += static_cast<int>(std::count_if(check.targets.begin(), check.targets.end(),
                                              [](const Target& t) { return t.IsClaimed(); }));
    }
  }
  return count;
}

bool IsNamed(const Claim& claim, const std::string& name) {
  return claim.id == name || claim.id.starts_with(name + ".");
}

// Seconds on all threads for a check that no verdict ends early.
double EstimateWork(const Check& check, const CheckRun& run, int num_threads) {
  if (!check.not_possible.empty()) return 0.0;
  constexpr std::uint32_t kLeastTimed = 4;
  constexpr double kLeastSeconds = 0.002, kMostSeconds = 0.1;
  const auto start = std::chrono::steady_clock::now();
  std::uint32_t num_timed = 0;
  std::chrono::duration<double> elapsed{};
  while ((num_timed < kLeastTimed || elapsed.count() < kLeastSeconds) && elapsed.count() < kMostSeconds) {
    check.trial({run.seed, run.condition, num_timed++, 0});
    elapsed = std::chrono::steady_clock::now() - start;
  }
  const double threads = check.is_timed ? 1.0 : num_threads;
  return elapsed.count() / num_timed * static_cast<double>(check.limits.Max(run.budget)) / threads;
}

}  // namespace

std::vector<Claim> SelectClaims(const std::vector<Claim>& all, const std::vector<std::string>& only) {
  for (const std::string& name : only) {
    if (std::none_of(all.begin(), all.end(), [&](const Claim& claim) { return IsNamed(claim, name); })) {
      throw InputError(fmt::format("--only: '{}' is not allowed; `rcme list claims` shows the ids", name));
    }
  }
  std::vector<Claim> selected;
  for (const Claim& claim : all) {
    const auto names_it = [&](const std::string& name) { return IsNamed(claim, name); };
    if (only.empty() || std::any_of(only.begin(), only.end(), names_it)) selected.push_back(claim);
  }
  return selected;
}

Audit PlanAudit(const std::vector<Claim>& all, const AuditOptions& options) {
  Audit audit{options, CountTargets(all), 0.0, SelectClaims(all, options.only), {}};
  audit.confidence = 1.0 - kAuditErrorRate / std::max(audit.num_targets, 1);
  for (const Claim& claim : audit.claims) {
    audit.results.emplace_back().checks.resize(claim.checks.size());
  }
  return audit;
}

std::vector<CheckPlace> ListCheckPlaces(const Audit& plan) {
  std::vector<CheckPlace> places;
  for (size_t claim = 0; claim < plan.claims.size(); ++claim) {
    for (size_t check = 0; check < plan.claims[claim].checks.size(); ++check)
      places.push_back({claim, check});
  }
  return places;
}

CheckRun MakeCheckRun(const Audit& plan, const CheckPlace& place) {
  const AuditOptions& options = plan.options;
  return {options.seed, StreamCondition(plan.claims[place.claim].id, place.check), options.budget,
          plan.confidence, options.num_threads};
}

const Check& CheckAt(const Audit& plan, const CheckPlace& place) {
  return plan.claims[place.claim].checks[place.check];
}

void JudgeClaims(Audit* audit) {
  for (size_t i = 0; i < audit->claims.size(); ++i) JudgeClaim(audit->claims[i], &audit->results[i]);
}

std::vector<double> EstimateSeconds(const Audit& plan) {
  const int num_threads = NumThreads(plan.options.num_threads);
  std::vector<double> seconds;
  for (const CheckPlace& place : ListCheckPlaces(plan))
    seconds.push_back(EstimateWork(CheckAt(plan, place), MakeCheckRun(plan, place), num_threads));
  return seconds;
}

}  // namespace rcme
