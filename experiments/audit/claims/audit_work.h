// The work of `rcme audit` (core/work/work_plan.h). It is divided in one of two ways, which give the same
// bytes except for measured times. On one machine an item is a whole check with its own threads, so that no
// trial is wasted.
//
// On many machines an item is a block of trials of a check (TrialBlocks), and a group is a check. The work
// proceeds in rounds, because the number of trials that a check needs depends on their outcomes. The shards
// run what a round needs; their merged parts show which checks are undecided and what the next round needs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/audit/claims/audit.h"
#include "experiments/audit/claims/claim.h"
#include "experiments/core/work/runner.h"

namespace rcme {

inline constexpr double kRoundGrowth = 1.5;

// Divides the trials of a check that stops at its first verdict among many machines.
//
// The trials are divided into rounds. The first round ends at the first look at which a verdict counts
// (TrialLimits::min). Each later one ends at the first look with kRoundGrowth times the trials before it, and
// the last at the end of the budget. A check that no verdict can end has a single round.
//
// Within a round there are no looks. Its trials form blocks whose lengths differ by at most one trial, and
// any machine may run a block. After the round the trials are examined one by one as on one machine
// (CheckDecision); if that ends the check, no further round begins. So the verdict is that of one machine to
// the last bit. The wasted trials are fewer than (kRoundGrowth * 1.25 - 1) times those needed, because looks
// are up to a quarter apart. None are wasted if the check runs to its budget.
class TrialBlocks {
 public:
  TrialBlocks(const Check& check, Budget budget);

  // 0 for a check that is not possible.
  size_t NumBlocks() const { return begins_.size() - 1; }
  std::int64_t Begin(size_t block) const { return begins_[block]; }
  std::int64_t End(size_t block) const { return begins_[block + 1]; }
  // Number of blocks up to the end of the round of this block.
  size_t RoundEnd(size_t block) const;

 private:
  std::vector<std::int64_t> begins_ = {0};  // trials; the last entry is the total
  std::vector<size_t> round_ends_;          // blocks, ascending
};

// For one machine. The runner computes one check at a time.
WorkPlan PlanAuditChecks(const Audit& plan);
// Decides the selected claims of `all`, each target at confidence 1 - kAuditErrorRate / num_targets
// (Bonferroni). Prints beforehand how long it may take. A claim's result does not depend on which others are
// run, because its id names its random streams. Throws as Runner::Get.
Audit RunAudit(const std::vector<Claim>& all, const AuditOptions& options, Runner* runner);

// For many machines.
WorkPlan PlanAuditBlocks(const Audit& plan);

// Number of blocks that each check needs, including those of earlier rounds; in the order of ListCheckPlaces.
using AuditRound = std::vector<size_t>;
AuditRound FirstRound(const Audit& plan);

// Write and read a round as a file. ReadRound throws InputError for a file of another audit.
void WriteRound(const Audit& plan, const AuditRound& round, const std::string& path);
AuditRound ReadRound(const Audit& plan, const std::string& path);

// Gets the runner's blocks of the round. Throws as Runner::Get.
void GetAuditRound(const Audit& plan, const AuditRound& round, Runner* runner);

struct MergedAudit {
  Audit audit;
  AuditRound round;      // what the checks need; for a decided check, what it took
  MissingItems missing;  // of `round`; if there are any, the audit is not usable
  WorkResults parts;
  double unneeded_seconds = 0.0;  // processor time of blocks after the verdict of their check
};

// The audit described by `options`, from its parts in any order and grouping. Throws InputError as
// MergeParts.
MergedAudit MergeAuditParts(const std::vector<Claim>& all, const AuditOptions& options,
                            const std::vector<std::string>& paths);

}  // namespace rcme
