// An audit on many machines. Each decides a fixed share of the checks, a shard, into a file of its own; the
// files of all shards together give the audit that one machine would have given, byte for byte (measured
// times excepted).
//
// Shard i of n has those checks k of the claim at place c of the audit with ShardOf(c, k, n) = i
// (study/shard.h): the checks of a claim, whatever it costs, are divided evenly to within one. A check is not
// divided: it stops at its first verdict, which depends on all its trials.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/claims/audit.h"
#include "experiments/study/shard.h"

namespace rcme {

// The checks of the shard, in their order.
std::vector<CheckPlace> PlacesOf(const Audit& plan, const Shard& shard);

// Decides them into the file at `path`, which is written every ten seconds, when the audit is stopped, and at
// the end; what it holds already is not decided again. Throws InputError if it holds another part, Stopped.
void RunAuditPart(const std::vector<Claim>& all, const AuditOptions& options, const Shard& shard,
                  const std::string& path);

struct MergedAudit {
  Audit audit;
  int num_missing = 0;                        // checks; if any, the audit is of no use
  std::uint32_t num_shards = 1;               // of each part
  std::vector<std::uint32_t> missing_shards;  // ascending
};

// The audit that `options` describe, from its parts in any order. A check that two parts have counts once.
// Throws InputError that names the part and what differs for one of another audit, program or number of
// shards, for one of another instruction set than the first, and for a check that is not equal in two parts.
MergedAudit MergeAuditParts(const std::vector<Claim>& all, const AuditOptions& options,
                            const std::vector<std::string>& paths);

}  // namespace rcme
