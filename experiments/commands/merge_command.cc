#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/work/runner.h"
#include "experiments/core/work/shard.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/run/store/merge_results.h"
#include "experiments/statistics/merge_counts.h"
#include "experiments/statistics/summarize_counts.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct MergeArguments {
  std::vector<std::string> parts;
  std::string out;
  bool is_check = false, is_partial = false;
  MergeOptions options;
};

std::string MissingInWords(const MergeReport& report) {
  if (report.num_shards == 0) {
    return fmt::format(
        "{} trials are missing; which shards have them is not known, for the parts are of "
        "different numbers of shards",
        report.num_missing);
  }
  if (report.num_shards == 1) return fmt::format("{} trials are missing", report.num_missing);
  return fmt::format("{} trials are missing, of the shards {} of {}", report.num_missing,
                     ArrayText(report.missing_shards), report.num_shards);
}

// Parts of both kinds are refused, whichever of them comes first.
bool KeepCounts(const std::vector<std::string>& parts) { return std::ranges::any_of(parts, KeepsCounts); }

// The shards alone go to standard output, for the shell.
void CheckMissing(const MergeArguments& arguments) {
  const auto check = KeepCounts(arguments.parts) ? CheckCounts : CheckParts;
  const MergeReport report = check(arguments.parts, arguments.options);
  for (const std::string& part : report.unreadable) PrintMessage("{}\n", part);
  if (report.num_missing == 0) {
    PrintMessage("{} trials, none is missing\n", report.num_trials);
    if (report.unreadable.empty()) return;
    throw InputError("the parts above cannot be merged; the others have all trials");
  }
  PrintMessage("{}\n", MissingInWords(report));
  if (report.num_shards > 1) fmt::print("{}\n", ArrayText(report.missing_shards));
  throw EndWith{kTryAgain};
}

// Of another command than `rcme run` (core/work/part_file.h): which pieces its work has, that command alone
// knows.
void JoinTheParts(const MergeArguments& arguments) {
  if (!arguments.is_partial) {
    throw InputError(
        "these are parts of `rcme audit`, `tune`, `transfer` or `map`: the same command with --merge puts "
        "them together and says what is missing; --partial makes one part of several");
  }
  CheckIsNoInput(arguments.out, arguments.parts);
  const Part joined = JoinParts(arguments.parts);
  WritePart(arguments.out, joined, joined.results);
  PrintMessage("{} parts of a {}, {} pieces -> {}\n", arguments.parts.size(), joined.work,
               joined.results.size(), arguments.out);
}

void MergeResultFiles(const MergeArguments& arguments) {
  const StopOnSignals stop;
  const auto merge = KeepCounts(arguments.parts) ? MergeCounts : MergeResults;
  const MergeReport report = merge(arguments.parts, arguments.out, arguments.is_partial, arguments.options);
  if (report.num_missing > 0 && !arguments.is_partial) {
    PrintMessage("{}; nothing was written (--partial writes what there is)\n", MissingInWords(report));
    throw EndWith{kTryAgain};
  }
  PrintMessage("{} parts, {} trials{} -> {}; next: rcme summarize {}\n", arguments.parts.size(),
               report.num_trials,
               report.num_twice > 0 ? fmt::format(" ({} read twice, and equal)", report.num_twice) : "",
               arguments.out, arguments.out);
  if (report.num_missing > 0) PrintMessage("{}\n", MissingInWords(report));
}

}  // namespace

void AddMergeCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("merge", "The result files of many shards, or runs, of a study as one");
  command->footer(
      "A trial is a function of the study, its seed and its number: whatever the parts were computed by, in\n"
      "any number, order and grouping, `rcme summarize` gives the bytes that it gives for one run. Refused,\n"
      "with what differs: parts of another study, option or seed, program or instruction set, and a trial\n"
      "that two parts have and not equal. The file appears whole or not at all, and only if no trial is\n"
      "missing; else the exit code is 75 (try again), also of --check.\n"
      "\n"
      "Examples:\n"
      "  rcme merge parts/*.sqlite --out run.sqlite\n"
      "  sbatch --array=$(rcme merge parts/*.sqlite --check) job.sh    what is missing, again\n"
      "  rcme merge parts/1*.sqlite --partial --out some.sqlite        to be merged further, or to look at");
  auto arguments = std::make_shared<MergeArguments>();
  command
      ->add_option(
          "parts", arguments->parts,
          "result files of `rcme run` or `rcme merge`; with --partial also parts of `rcme audit`, `tune`, "
          "`transfer` or `map`")
      ->required();
  CLI::Option* out = command->add_option("-o,--out", arguments->out, "new result file (SQLite)");
  CLI::Option* check =
      command
          ->add_flag(
              "--check", arguments->is_check,
              "write nothing; print the shards that are lost or not whole as the tasks of a Slurm array "
              "(3,17-19)")
          ->excludes(out);
  command->add_flag("--partial", arguments->is_partial, "write what there is, although trials are missing")
      ->excludes(check);
  command->add_flag("--mixed-instruction-sets", arguments->options.are_instruction_sets_mixed,
                    "parts of machines with different instruction sets: their trials may differ in the last "
                    "bits of a number");
  command->callback([arguments] {
    const bool are_parts = std::ranges::any_of(arguments->parts, IsPart);
    if (arguments->is_check && !are_parts) return CheckMissing(*arguments);
    if (arguments->out.empty() && !arguments->is_check)
      throw InputError("--out: give the path of the merged file, or --check");
    are_parts ? JoinTheParts(*arguments) : MergeResultFiles(*arguments);
  });
}

}  // namespace rcme
