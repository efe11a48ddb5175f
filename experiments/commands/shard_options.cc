#include "experiments/commands/shard_options.h"

#include <fmt/format.h>

#include "experiments/core/text/message.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/time_limit.h"

namespace rcme {

Shard ShardArguments::ThisShard() const { return ParseShard(shard, ThisEnvironment()); }

ShardOptions AddShardOptions(CLI::App* command, const std::string& pieces, ShardArguments* arguments) {
  ShardOptions options{};
  options.shard = command->add_option(
      "--shard", arguments->shard,
      fmt::format("I/N: the I-th of N shares of the {}, into a file of its own, --out; auto/N or auto: which "
                  "one this is in a Slurm array or a Kubernetes indexed job (docs/many_machines.md)",
                  pieces));
  options.merge = command
                      ->add_option("--merge", arguments->parts,
                                   fmt::format("the files of all shards, given with the study and options "
                                               "that they were made with; where {} are missing, prints the "
                                               "shards that have them (3,17-19) and ends with exit code 75",
                                               pieces))
                      ->excludes(options.shard);
  AddTimeLimit(command, pieces, &arguments->max_time)->needs(options.shard);
  return options;
}

void RequireNoneMissing(const PiecePlan& plan, const MissingPieces& missing, std::uint32_t num_shards) {
  if (missing.num_pieces == 0) return;
  const std::string shards = ArrayText(missing.shards);
  PrintMessage("{} {}s are missing, of the shards {} of {}; no result was written\n", missing.num_pieces,
               plan.piece_name, shards, num_shards);
  fmt::print("{}\n", shards);
  throw EndWith{kTryAgain};
}

void PrintCosts(const PiecePlan& plan, const MergedParts& merged) {
  PrintMessage("{}\n", CostsInWords(plan, merged));
}

void PrintPartIsDone(const Shard& shard, const std::string& path) {
  PrintMessage("done: shard {} of {} in {}; next, with all of them: the same command, --merge PARTS\n",
               shard.number, shard.count, path);
}

}  // namespace rcme
