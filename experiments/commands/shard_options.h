// What the commands have in common whose work is divided into pieces (core/work/piece_plan.h): audit, tune,
// transfer, map.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "experiments/core/work/divided_work.h"

namespace rcme {

struct ShardArguments {
  std::string shard, max_time;     // empty: all pieces, no limit
  std::vector<std::string> parts;  // to be merged; empty: none

  Shard ThisShard() const;
};

// The options --shard, --merge and --max-time; `pieces` are "checks".
struct ShardOptions {
  CLI::Option *shard, *merge;
};
ShardOptions AddShardOptions(CLI::App* command, const std::string& pieces, ShardArguments* arguments);

// Where pieces are missing, says so, prints the shards that have them for the shell, and ends the command
// with exit code 75.
void RequireNoneMissing(const PiecePlan& plan, const MissingPieces& missing, std::uint32_t num_shards);

// Once nothing is missing: what the pieces took, on standard error.
void PrintCosts(const PiecePlan& plan, const MergedParts& merged);

// The last word of a command that has done its part.
void PrintPartIsDone(const Shard& shard, const std::string& path);

}  // namespace rcme
