// Options and messages shared by the commands whose work is a list of items (core/work/work_plan.h).
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "experiments/core/work/runner.h"

namespace rcme {

struct ShardArguments {
  std::string shard, max_time;     // empty: all items, no limit
  std::vector<std::string> parts;  // files to merge; may be empty

  Shard ThisShard() const;
};

// The options --shard, --merge and --max-time. `pieces` names the items in their help: "checks".
struct ShardOptions {
  CLI::Option *shard, *merge;
};
ShardOptions AddShardOptions(CLI::App* command, const std::string& pieces, ShardArguments* arguments);

// The checkpoint file of a command that may be stopped: in the folder `out`, or beside the file `out`. Beside
// a device or pipe there is none, and the path is empty.
std::string FindCheckpointInFolder(const std::string& out);
std::string FindCheckpointBeside(const std::string& out);

// The runner for the options: for a shard with the part file `out`, from parts, or with a checkpoint.
Runner MakeRunner(const WorkPlan& plan, const ShardArguments& arguments, const std::string& out,
                  const std::string& checkpoint, int num_threads);

// A runner with this checkpoint, or in memory if `checkpoint` is empty.
Runner MakeRunner(const WorkPlan& plan, const std::string& checkpoint, int num_threads);

// Prints the cost of the items on standard error if the runner reads parts. No item may be missing.
void PrintCosts(const Runner& runner);

// Throws ItemsAreMissing if items of the plan are missing; otherwise calls PrintCosts.
void RequireWhole(const Runner& runner);

// The final message of a command that has finished its shard.
void PrintPartIsDone(const Shard& shard, const std::string& path);

}  // namespace rcme
