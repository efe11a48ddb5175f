#include "experiments/commands/shard_options.h"

#include <fmt/format.h>

#include <filesystem>

#include "experiments/commands/common_options.h"
#include "experiments/core/text/message.h"

namespace rcme {

Shard ShardArguments::ThisShard() const { return ParseShard(shard, ThisEnvironment()); }

ShardOptions AddShardOptions(CLI::App* command, const std::string& pieces, ShardArguments* arguments) {
  ShardOptions options{};
  options.shard = command->add_option(
      "--shard", arguments->shard,
      fmt::format("I/N: run the I-th of N shares of the {} into the file --out; "
                  "auto/N or auto: the share of this task of a Slurm array or Kubernetes indexed job "
                  "(docs/many_machines.md)",
                  pieces));
  options.merge =
      command
          ->add_option(
              "--merge", arguments->parts,
              fmt::format("merge the files of all shards; give the same study and options. "
                          "If {} are missing, prints their shards (3,17-19) and ends with exit code 75",
                          pieces))
          ->excludes(options.shard);
  AddTimeLimit(command, pieces, &arguments->max_time);
  return options;
}

std::string FindCheckpointInFolder(const std::string& out) {
  return (std::filesystem::path(out) / "unfinished.part").string();
}

std::string FindCheckpointBeside(const std::string& out) {
  const bool is_device = std::filesystem::exists(out) && !std::filesystem::is_regular_file(out);
  return is_device ? "" : out + ".unfinished.part";
}

Runner MakeRunner(const WorkPlan& plan, const ShardArguments& arguments, const std::string& out,
                  const std::string& checkpoint, int num_threads) {
  if (!arguments.shard.empty()) return Runner::OfShard(plan, arguments.ThisShard(), out, num_threads);
  if (!arguments.parts.empty()) return Runner::FromParts(plan, arguments.parts);
  return MakeRunner(plan, checkpoint, num_threads);
}

Runner MakeRunner(const WorkPlan& plan, const std::string& checkpoint, int num_threads) {
  return checkpoint.empty() ? Runner::InMemory(plan, num_threads)
                            : Runner::WithCheckpoint(plan, checkpoint, num_threads);
}

void PrintCosts(const Runner& runner) {
  if (runner.ReadsParts()) PrintMessage("{}\n", DescribeCosts(runner.plan(), runner.results()));
}

void RequireWhole(const Runner& runner) {
  const WorkPlan& plan = runner.plan();
  RequireNoneMissing(plan, FindMissingIn(plan, runner.results(), 0, plan.groups.size()),
                     runner.results().num_shards);
  PrintCosts(runner);
}

void PrintPartIsDone(const Shard& shard, const std::string& path) {
  PrintMessage(
      "done: shard {} of {} in {}; next, when all shards are done: the same command with --merge PARTS\n",
      shard.number, shard.count, path);
}

}  // namespace rcme
