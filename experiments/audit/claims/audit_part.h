// An audit on many machines. A piece is a block of trials of a check (trial_blocks.h), a group a check
// (core/work/piece_plan.h), so that the parts of all shards together give the audit that one machine would have
// given, byte for byte (measured times excepted).
//
// An audit goes in rounds, for how many trials a check needs depends on their outcomes: the shards run what a
// round needs, and their parts together say which checks are not decided and what the next round needs.
#pragma once

#include <string>
#include <vector>

#include "experiments/audit/claims/audit.h"
#include "experiments/core/work/divided_work.h"

namespace rcme {

PiecePlan PiecesOfAudit(const Audit& plan);

// How many blocks of each check are needed, those of the rounds before among them; as PlacesOf.
using AuditRound = std::vector<size_t>;
AuditRound FirstRound(const Audit& plan);

// In a file. ReadRound throws InputError for one that is not of this audit.
void WriteRound(const Audit& plan, const AuditRound& round, const std::string& path);
AuditRound ReadRound(const Audit& plan, const std::string& path);

// Runs the shard's blocks of the round into the file at `path`; what it holds already is not run again.
// Throws InputError if it holds another part, Stopped.
void RunAuditPart(const Audit& plan, const AuditRound& round, const Shard& shard, const std::string& path);

struct MergedAudit {
  Audit audit;
  AuditRound round;       // what the checks need: of one that is decided as much as it took
  MissingPieces missing;  // of that; if any, the audit is of no use
  MergedParts parts;
  double unneeded_seconds = 0.0;  // of processor time, for blocks after those that a check took
};

// The audit that `options` describe, from its parts in any order and grouping. Throws InputError as
// MergeParts.
MergedAudit MergeAuditParts(const std::vector<Claim>& all, const AuditOptions& options,
                            const std::vector<std::string>& paths);

}  // namespace rcme
