// Options and messages shared by the commands whose work is a list of items (core/work/work_plan.h).
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "experiments/core/work/runner.h"

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

// Where a command that was stopped keeps its results: in the folder `out`, or beside the file. Nothing (no
// checkpoint) where `out` is a device or a pipe.
std::string FindCheckpointInFolder(const std::string& out);
std::string FindCheckpointBeside(const std::string& out);

// The runner that the options ask for: of a shard, whose part is `out`, of parts, or with a checkpoint.
Runner MakeRunner(const WorkPlan& plan, const ShardArguments& arguments, const std::string& out,
                  const std::string& checkpoint, int num_threads);

// With the checkpoint, or in memory where there is none.
Runner MakeRunner(const WorkPlan& plan, const std::string& checkpoint, int num_threads);

// Once nothing is missing of parts: what the items took, on standard error.
void PrintCosts(const Runner& runner);

// Of the parts of a whole plan: throws ItemsAreMissing if some are; then PrintCosts.
void RequireWhole(const Runner& runner);

// The last word of a command that has done its part.
void PrintPartIsDone(const Shard& shard, const std::string& path);

}  // namespace rcme
