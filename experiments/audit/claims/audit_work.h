// The work of `rcme audit` (core/work/work_plan.h), divided in one of two ways that give the same bytes
// (measured times excepted). On one machine an item is a whole check, with threads of its own, so that no
// trial is run in vain.
//
// On many machines an item is a block of trials of a check (trial_blocks.h), a group a check. It goes in
// rounds, for how many trials a check needs depends on their outcomes: the shards run what a round needs, and
// their parts together say which checks are not decided and what the next round needs.
#pragma once

#include <string>
#include <vector>

#include "experiments/audit/claims/audit.h"
#include "experiments/core/work/runner.h"

namespace rcme {

// On one machine. The runner computes one check at a time.
WorkPlan PlanAuditChecks(const Audit& plan);
// Decides the selected claims of `all`, each target at confidence 1 - kAuditErrorRate / num_targets
// (Bonferroni), and says beforehand how long it may take. A claim's result does not depend on which others
// are run: its random streams are named by its id. Throws as Runner::Get.
Audit RunAudit(const std::vector<Claim>& all, const AuditOptions& options, Runner* runner);

// On many machines.
WorkPlan PlanAuditBlocks(const Audit& plan);

// How many blocks of each check are needed, those of the rounds before among them; as ListCheckPlaces.
using AuditRound = std::vector<size_t>;
AuditRound FirstRound(const Audit& plan);

// In a file. ReadRound throws InputError for one that is not of this audit.
void WriteRound(const Audit& plan, const AuditRound& round, const std::string& path);
AuditRound ReadRound(const Audit& plan, const std::string& path);

// Gets the runner's blocks of the round. Throws as Runner::Get.
void GetAuditRound(const Audit& plan, const AuditRound& round, Runner* runner);

struct MergedAudit {
  Audit audit;
  AuditRound round;      // what the checks need: of one that is decided as much as it took
  MissingItems missing;  // of that; if any, the audit is of no use
  WorkResults parts;
  double unneeded_seconds = 0.0;  // of processor time, for blocks after those that a check took
};

// The audit that `options` describe, from its parts in any order and grouping. Throws InputError as
// MergeParts.
MergedAudit MergeAuditParts(const std::vector<Claim>& all, const AuditOptions& options,
                            const std::vector<std::string>& paths);

}  // namespace rcme
