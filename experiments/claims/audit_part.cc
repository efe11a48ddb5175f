#include "experiments/claims/audit_part.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "estimator/instruction_set.h"
#include "experiments/base/file_output.h"
#include "experiments/base/program_name.h"
#include "experiments/base/stop_request.h"
#include "experiments/claims/audit_part_file.h"
#include "experiments/result_file/first_difference.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// What the results depend on, a line for each thing.
std::string Identity(const Audit& plan) {
  const AuditOptions& options = plan.options;
  std::string identity = fmt::format("seed: {}\nbudget: {}\n", options.seed,
                                     options.budget == Budget::kQuick ? "quick" : "full");
  for (const Claim& claim : plan.claims) {
    identity += fmt::format("claim: {}, {} checks\n", claim.id, claim.checks.size());
  }
  identity += fmt::format("claimed numbers: {}\n", plan.num_targets);
  for (const auto& [key, value] : options.conditions) identity += fmt::format("{}: {}\n", key, value);
  return identity + options.study_identity;
}

std::uint32_t ShardOfCheck(const CheckPlace& place, std::uint32_t count) {
  return ShardOf(static_cast<std::uint32_t>(place.claim), static_cast<std::uint32_t>(place.check), count);
}

AuditPart NewPart(const Audit& plan, const Shard& shard) {
  return {Identity(plan), shard, {ProgramName(), InstructionSetName()}, {}};
}

void RequireSame(const std::string& path, const std::string& other, const std::string& what,
                 const std::string& there, const std::string& here) {
  if (there == here) return;
  throw InputError(
      fmt::format("{}: does not belong to {}: {}, {}", path, other, what, FirstDifference(there, here)));
}

// What every part of the audit has in common with the plan.
void RequirePartOf(const Audit& plan, const std::string& path, const AuditPart& part) {
  RequireSame(path, "this audit", "another program", part.origin.program, ProgramName());
  RequireSame(path, "this audit", "another audit", part.identity, Identity(plan));
  const std::string damaged = fmt::format("{}: damaged", path);
  for (const auto& [place, result] : part.results) {
    if (place.claim >= plan.claims.size() || place.check >= plan.claims[place.claim].checks.size() ||
        ShardOfCheck(place, part.shard.count) != part.shard.number)
      throw InputError(
          fmt::format("{}: check {} of claim {} is none of its shard", damaged, place.check, place.claim));
    const Check& check = plan.claims[place.claim].checks[place.check];
    const size_t num_targets = check.not_possible.empty() ? check.targets.size() : 0;
    if (result.targets.size() != num_targets)
      throw InputError(fmt::format("{}: check {} of claim {} has {} targets, not {}", damaged, place.check,
                                   plan.claims[place.claim].id, result.targets.size(), num_targets));
  }
}

AuditPart ReadPartOf(const Audit& plan, const std::string& path) {
  AuditPart part = ReadAuditPart(path);
  if (part.shard.number < 1 || part.shard.number > part.shard.count || part.shard.count > kMaxShards)
    throw InputError(
        fmt::format("{}: damaged: there is no shard {} of {}", path, part.shard.number, part.shard.count));
  RequirePartOf(plan, path, part);
  return part;
}

std::string NumberInWords(const Shard& shard) { return fmt::format("{}/{}", shard.number, shard.count); }

// The part as the file at `path` has it, or a new one.
AuditPart OpenPart(const Audit& plan, const Shard& shard, const std::string& path) {
  AuditPart part = NewPart(plan, shard);
  if (!std::filesystem::exists(path)) {
    CheckCanBeWritten(path);
    return part;
  }
  const AuditPart before = ReadPartOf(plan, path);
  RequireSame(path, "this audit", "another shard", NumberInWords(before.shard), NumberInWords(shard));
  RequireSame(path, "this machine", "another instruction set", before.origin.instruction_set,
              part.origin.instruction_set);
  return before;
}

// Where a check comes from that is in several parts.
using Sources = std::map<CheckPlace, std::string>;

void AddPart(const std::string& path, const AuditPart& part, Audit* audit, Sources* sources) {
  for (const auto& [place, result] : part.results) {
    CheckResult& merged = audit->results[place.claim].checks[place.check];
    const auto [source, is_new] = sources->emplace(place, path);
    if (is_new) {
      merged = result;
    } else if (ResultAsText(result) != ResultAsText(merged)) {
      throw InputError(fmt::format("{}: check {} of claim {} is not equal to that of {}", path, place.check,
                                   audit->claims[place.claim].id, source->second));
    }
  }
}

}  // namespace

std::vector<CheckPlace> PlacesOf(const Audit& plan, const Shard& shard) {
  std::vector<CheckPlace> places = PlacesOf(plan);
  std::erase_if(places,
                [&](const CheckPlace& place) { return ShardOfCheck(place, shard.count) != shard.number; });
  return places;
}

void RunAuditPart(const std::vector<Claim>& all, const AuditOptions& options, const Shard& shard,
                  const std::string& path) {
  constexpr std::chrono::seconds kBetweenWrites{10};
  const Audit plan = PlanAudit(all, options);
  AuditPart part = OpenPart(plan, shard, path);
  std::vector<CheckPlace> left = PlacesOf(plan, shard);
  const size_t num_checks = left.size();
  std::erase_if(left, [&](const CheckPlace& place) { return part.results.contains(place); });
  auto last_write = std::chrono::steady_clock::now();
  try {
    DecideChecks(plan, left, [&](const CheckPlace& place, CheckResult result) {
      part.results.emplace(place, std::move(result));
      if (std::chrono::steady_clock::now() - last_write < kBetweenWrites) return;
      WriteFileWhole(path, PartAsJson(part));
      last_write = std::chrono::steady_clock::now();
    });
  } catch (const Stopped&) {
    WriteFileWhole(path, PartAsJson(part));
    throw Stopped(fmt::format("stopped; {} has {} of {} checks, the same command goes on", path,
                              part.results.size(), num_checks));
  }
  WriteFileWhole(path, PartAsJson(part));
}

MergedAudit MergeAuditParts(const std::vector<Claim>& all, const AuditOptions& options,
                            const std::vector<std::string>& paths) {
  MergedAudit merged{PlanAudit(all, options), 0, 1, {}};
  Sources sources;
  TrialOrigin origin;
  for (const std::string& path : paths) {
    const AuditPart part = ReadPartOf(merged.audit, path);
    if (path == paths.front()) merged.num_shards = part.shard.count, origin = part.origin;
    RequireSame(path, paths.front(), "another number of shards", fmt::format("{}", part.shard.count),
                fmt::format("{}", merged.num_shards));
    RequireSame(path, paths.front(), "another instruction set", part.origin.instruction_set,
                origin.instruction_set);
    AddPart(path, part, &merged.audit, &sources);
  }
  std::set<std::uint32_t> missing;
  for (const CheckPlace& place : PlacesOf(merged.audit)) {
    if (sources.contains(place)) continue;
    ++merged.num_missing;
    missing.insert(ShardOfCheck(place, merged.num_shards));
  }
  merged.missing_shards.assign(missing.begin(), missing.end());
  if (merged.num_missing == 0) JudgeClaims(&merged.audit);
  return merged;
}

}  // namespace rcme
