#include "experiments/audit/claims/audit_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "estimator/instruction_set.h"
#include "experiments/audit/claims/decide_check.h"
#include "experiments/audit/claims/outcomes_json.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/program_name.h"
#include "experiments/core/work/for_each_index.h"
#include "experiments/core/work/progress.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// Most blocks of a round: up to this many machines get equal shares.
constexpr std::int64_t kBlocksOfRound = 64;

// The first look with at least this many trials.
std::int64_t LookWith(const Check& check, Budget budget, double num_trials) {
  std::int64_t look = 0;
  do look = NextLook(check, budget, look);
  while (static_cast<double>(look) < num_trials && look < check.limits.Max(budget));
  return look;
}

// Everything on which the results depend, one line each.
std::string Identity(const Audit& plan) {
  const AuditOptions& options = plan.options;
  std::string identity = fmt::format("seed: {}\nbudget: {}\nclaimed numbers: {}\n", options.seed,
                                     options.budget == Budget::kQuick ? "quick" : "full", plan.num_targets);
  for (const auto& [key, value] : options.conditions) identity += fmt::format("{}: {}\n", key, value);
  return identity + options.study_identity;
}

WorkPlan PlanOfChecks(const Audit& plan, const std::string& work, const std::string& item_name,
                      const AuditRound& num_items) {
  WorkPlan items{work, item_name, Identity(plan), {}};
  for (const CheckPlace& place : ListCheckPlaces(plan)) {
    items.groups.push_back({fmt::format("check {} of claim {}", place.check, plan.claims[place.claim].id),
                            num_items[items.groups.size()]});
  }
  return items;
}

// A round is stored like a part, with one piece per check: the number of blocks it needs.
WorkPlan PlanRound(const Audit& plan) {
  return PlanOfChecks(plan, "round of an audit", "number", AuditRound(ListCheckPlaces(plan).size(), 1));
}

std::vector<TrialBlocks> MakeTrialBlocks(const Audit& plan) {
  std::vector<TrialBlocks> blocks;
  for (const CheckPlace& place : ListCheckPlaces(plan))
    blocks.emplace_back(CheckAt(plan, place), plan.options.budget);
  return blocks;
}

// The pieces that a round needs.
std::vector<ItemPlace> ListItems(const AuditRound& round) {
  std::vector<ItemPlace> places;
  for (size_t group = 0; group < round.size(); ++group) {
    for (size_t block = 0; block < round[group]; ++block) places.push_back({group, block});
  }
  return places;
}

// Evaluates those blocks of a check that the parts hold, in order, up to the first gap or the verdict. Sets
// the check's result and returns how many blocks it needs.
size_t CountBlocks(const Audit& plan, const CheckPlace& place, const TrialBlocks& blocks, size_t group,
                   const WorkPlan& pieces, const WorkResults& parts, CheckResult* result) {
  const Check& check = CheckAt(plan, place);
  CheckDecision decision(check, MakeCheckRun(plan, place));
  size_t num_counted = 0;
  ReadResults(pieces, parts, group, group + 1, [&](const ItemPlace& piece, const std::string& json) {
    if (piece.item != num_counted || decision.IsDone()) return;
    const std::int64_t num_trials = blocks.End(num_counted) - blocks.Begin(num_counted);
    for (const Outcome& outcome : OutcomesFrom(check, json, static_cast<size_t>(num_trials)))
      decision.Add(outcome);
    ++num_counted;
  });
  *result = decision.Result();
  return decision.IsDone() ? num_counted : blocks.RoundEnd(num_counted);
}

constexpr double kLongSeconds = 900.0;

// How to make a long audit shorter.
std::string DescribeBounds(const AuditOptions& options) {
  const std::string of_study =
      options.study_identity.empty() ? "" : ", --set FACTOR=LEVEL (one level of a factor of the study)";
  return fmt::format(
      "To bound it: --max-time 30m (the same command goes on later), --only FAMILY (`rcme list claims`){}\n",
      of_study);
}

}  // namespace

TrialBlocks::TrialBlocks(const Check& check, Budget budget) {
  if (!check.not_possible.empty()) return;
  const std::int64_t max_trials = check.limits.Max(budget);
  double wanted =
      CanEndEarly(check) ? static_cast<double>(check.limits.min) : static_cast<double>(max_trials);
  while (begins_.back() < max_trials) {
    const std::int64_t begin = begins_.back(), num_trials = LookWith(check, budget, wanted) - begin;
    const std::int64_t num_blocks = std::min(num_trials, kBlocksOfRound);
    for (std::int64_t block = 1; block <= num_blocks; ++block)
      begins_.push_back(begin + num_trials * block / num_blocks);
    round_ends_.push_back(begins_.size() - 1);
    wanted = kRoundGrowth * static_cast<double>(begins_.back());
  }
}

size_t TrialBlocks::RoundEnd(size_t block) const { return *std::ranges::upper_bound(round_ends_, block); }

WorkPlan PlanAuditChecks(const Audit& plan) {
  return PlanOfChecks(plan, "audit on one machine", "check", AuditRound(ListCheckPlaces(plan).size(), 1));
}

Audit RunAudit(const std::vector<Claim>& all, const AuditOptions& options, Runner* runner) {
  Audit audit = PlanAudit(all, options);
  const std::vector<CheckPlace> places = ListCheckPlaces(audit);
  const std::vector<double> seconds = EstimateSeconds(audit);
  const double all_seconds = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  PrintMessage("audit: {} claims, {} checks; at most {} on {} threads, less where a verdict falls early\n",
               audit.claims.size(), places.size(), DescribeDuration(all_seconds),
               NumThreads(options.num_threads));
  if (all_seconds > kLongSeconds) PrintMessage("{}", DescribeBounds(options));
  const auto milliseconds = [&](const ItemPlace& item) {
    return static_cast<std::int64_t>(1000.0 * seconds[item.group]) + 1;
  };
  runner->Get(ListItems(runner->plan(), {}),
              [&](const ItemPlace& item) {
                const CheckPlace& place = places[item.group];
                return CheckResultAsJson(DecideCheck(CheckAt(audit, place), MakeCheckRun(audit, place)));
              },
              {"ms of work", milliseconds});
  ReadResults(runner->plan(), runner->results(), 0, places.size(),
              [&](const ItemPlace& item, const std::string& json) {
                const CheckPlace& place = places[item.group];
                audit.results[place.claim].checks[place.check] = CheckResultFrom(CheckAt(audit, place), json);
              });
  JudgeClaims(&audit);
  return audit;
}

WorkPlan PlanAuditBlocks(const Audit& plan) {
  AuditRound num_blocks;
  for (const TrialBlocks& blocks : MakeTrialBlocks(plan)) num_blocks.push_back(blocks.NumBlocks());
  return PlanOfChecks(plan, "audit", "block", num_blocks);
}

AuditRound FirstRound(const Audit& plan) {
  AuditRound round;
  for (const TrialBlocks& blocks : MakeTrialBlocks(plan))
    round.push_back(blocks.NumBlocks() == 0 ? 0 : blocks.RoundEnd(0));
  return round;
}

void WriteRound(const Audit& plan, const AuditRound& round, const std::string& path) {
  const WorkPlan pieces = PlanRound(plan);
  const Part part{pieces.work, DescribeIdentity(pieces), {0, 1}, {ProgramName(), InstructionSetName()}, {}};
  ItemResults results;
  for (size_t group = 0; group < round.size(); ++group)
    results[{group, 0}].json = fmt::format("{}", round[group]);
  WritePart(path, part, results);
}

AuditRound ReadRound(const Audit& plan, const std::string& path) {
  const WorkPlan pieces = PlanRound(plan);
  const WorkResults merged = MergeParts(pieces, {path});
  const std::vector<TrialBlocks> blocks = MakeTrialBlocks(plan);
  if (FindMissingIn(pieces, merged, 0, pieces.groups.size()).num_items > 0)
    throw InputError(fmt::format("{}: damaged: it lacks checks", path));
  AuditRound round(blocks.size());
  ReadResults(pieces, merged, 0, round.size(), [&](const ItemPlace& place, const std::string& json) {
    const auto num_blocks = static_cast<std::int64_t>(blocks[place.group].NumBlocks());
    round[place.group] = static_cast<size_t>(CountFrom(ParsePiece(json), num_blocks));
  });
  return round;
}

void GetAuditRound(const Audit& plan, const AuditRound& round, Runner* runner) {
  const std::vector<CheckPlace> checks = ListCheckPlaces(plan);
  const std::vector<TrialBlocks> blocks = MakeTrialBlocks(plan);
  std::vector<ItemPlace> its_own = ListItems(round);
  const Shard& shard = runner->shard();
  std::erase_if(its_own, [&](const ItemPlace& p) { return FindShardOfItem(p, shard.count) != shard.number; });
  runner->Get(its_own, [&](const ItemPlace& place) {
    const CheckPlace& at = checks[place.group];
    const TrialBlocks& of_check = blocks[place.group];
    const Check& check = CheckAt(plan, at);
    return OutcomesAsJson(check, RunTrials(check, MakeCheckRun(plan, at), of_check.Begin(place.item),
                                           of_check.End(place.item)));
  });
}

MergedAudit MergeAuditParts(const std::vector<Claim>& all, const AuditOptions& options,
                            const std::vector<std::string>& paths) {
  MergedAudit merged;
  merged.audit = PlanAudit(all, options);
  const WorkPlan pieces = PlanAuditBlocks(merged.audit);
  merged.parts = MergeParts(pieces, paths);
  const std::vector<CheckPlace> checks = ListCheckPlaces(merged.audit);
  const std::vector<TrialBlocks> blocks = MakeTrialBlocks(merged.audit);
  for (size_t group = 0; group < checks.size(); ++group) {
    CheckResult* result = &merged.audit.results[checks[group].claim].checks[checks[group].check];
    merged.round.push_back(
        CountBlocks(merged.audit, checks[group], blocks[group], group, pieces, merged.parts, result));
  }
  merged.missing = FindMissingAmong(ListItems(merged.round), merged.parts);
  for (const auto& [place, result] : merged.parts.results) {
    if (place.item >= merged.round[place.group]) merged.unneeded_seconds += result.seconds;
  }
  if (merged.missing.num_items == 0) JudgeClaims(&merged.audit);
  return merged;
}

}  // namespace rcme
