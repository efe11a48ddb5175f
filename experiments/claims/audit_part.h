// An audit on many machines: its pieces are the checks, the groups its claims (pieces/piece_plan.h), so that
// the parts of all shards together give the audit that one machine would have given, byte for byte (measured
// times excepted). A check is not divided: it stops at its first verdict, which depends on all its trials.
#pragma once

#include <string>
#include <vector>

#include "experiments/claims/audit.h"
#include "experiments/pieces/divided_work.h"

namespace rcme {

PiecePlan PiecesOfAudit(const Audit& plan);

// Decides the shard's checks into the file at `path`; what it holds already is not decided again. Throws
// InputError if it holds another part, Stopped.
void RunAuditPart(const std::vector<Claim>& all, const AuditOptions& options, const Shard& shard,
                  const std::string& path);

struct MergedAudit {
  Audit audit;
  MissingPieces missing;  // if any, the audit is of no use
  MergedParts parts;
};

// The audit that `options` describe, from its parts in any order and grouping. Throws InputError as
// MergeParts.
MergedAudit MergeAuditParts(const std::vector<Claim>& all, const AuditOptions& options,
                            const std::vector<std::string>& paths);

}  // namespace rcme
