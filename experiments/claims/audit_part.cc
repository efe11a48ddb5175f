#include "experiments/claims/audit_part.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "experiments/claims/check_result_json.h"

namespace rcme {
namespace {

// What the results depend on, a line for each thing.
std::string Identity(const Audit& plan) {
  const AuditOptions& options = plan.options;
  std::string identity = fmt::format("seed: {}\nbudget: {}\nclaimed numbers: {}\n", options.seed,
                                     options.budget == Budget::kQuick ? "quick" : "full", plan.num_targets);
  for (const auto& [key, value] : options.conditions) identity += fmt::format("{}: {}\n", key, value);
  return identity + options.study_identity;
}

// Throws std::exception for a result that is none of this check's.
CheckResult ResultOf(const Check& check, const std::string& json) {
  CheckResult result = ResultFrom(json);
  const size_t num_targets = check.not_possible.empty() ? check.targets.size() : 0;
  if (result.targets.size() != num_targets)
    throw std::invalid_argument(fmt::format("it has {} targets, not {}", result.targets.size(), num_targets));
  return result;
}

}  // namespace

PiecePlan PiecesOfAudit(const Audit& plan) {
  PiecePlan pieces{"audit", "check", Identity(plan), {}};
  for (const Claim& claim : plan.claims) pieces.groups.push_back({"claim " + claim.id, claim.checks.size()});
  return pieces;
}

void RunAuditPart(const std::vector<Claim>& all, const AuditOptions& options, const Shard& shard,
                  const std::string& path) {
  const Audit plan = PlanAudit(all, options);
  const PiecePlan pieces = PiecesOfAudit(plan);
  PartInWork part(pieces, shard, path);
  std::vector<CheckPlace> left;
  for (const PiecePlace& place : part.Left(PiecesOf(pieces, shard)))
    left.push_back({place.group, place.piece});
  part.Do([&] {
    DecideChecks(plan, left, [&](const CheckPlace& place, const CheckResult& result, double seconds) {
      part.Keep({place.claim, place.check}, {ResultAsJson(result), seconds});
    });
  });
}

MergedAudit MergeAuditParts(const std::vector<Claim>& all, const AuditOptions& options,
                            const std::vector<std::string>& paths) {
  MergedAudit merged{PlanAudit(all, options), {}, {}};
  const PiecePlan pieces = PiecesOfAudit(merged.audit);
  merged.parts = MergeParts(pieces, paths);
  merged.missing = MissingIn(pieces, merged.parts, 0, pieces.groups.size());
  ReadEach(pieces, merged.parts, 0, pieces.groups.size(),
           [&](const PiecePlace& place, const std::string& json) {
             const Check& check = merged.audit.claims[place.group].checks[place.piece];
             merged.audit.results[place.group].checks[place.piece] = ResultOf(check, json);
           });
  if (merged.missing.num_pieces == 0) JudgeClaims(&merged.audit);
  return merged;
}

}  // namespace rcme
