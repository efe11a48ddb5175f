#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/shell_word.h"
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
  std::string out, format = "table";
  bool is_check = false, is_partial = false;
  MergeOptions options;
};

std::string DescribeMissing(const MergeReport& report) {
  if (report.num_shards == 0) {
    return fmt::format(
        "{} trials are missing; their shards are unknown: "
        "the parts come from different numbers of shards",
        report.num_missing);
  }
  if (report.num_shards == 1) return fmt::format("{} trials are missing", report.num_missing);
  return fmt::format("{} trials are missing, of the shards {} of {}", report.num_missing,
                     ArrayText(report.missing_shards), report.num_shards);
}

// Whether any part keeps counts. A mixture of both kinds is then refused, whichever comes first.
bool KeepCounts(const std::vector<std::string>& parts) { return std::ranges::any_of(parts, KeepsCounts); }

// `text`: the result as printed in the format table, for people and for the shell.
CommandResult MakeMergeResult(const MergeArguments& arguments, const MergeReport& report,
                              const std::string& text) {
  Table table{{Column::Count("parts"), Column::Count("trials"), Column::Count("read_twice"),
               Column::Count("missing"), Column::Count("shards"), Column::Text("missing_shards"),
               Column::Count("unreadable"), Column::Text("file")}};
  table.rows.push_back({std::ssize(arguments.parts), report.num_trials, report.num_twice, report.num_missing,
                        std::int64_t{report.num_shards}, ArrayText(report.missing_shards),
                        std::ssize(report.unreadable), arguments.out});
  return MakeResult(text, kMergeFormat, {}, table);
}

// Prints only the missing shards on standard output, for the shell.
void CheckMissing(const MergeArguments& arguments) {
  const auto check = KeepCounts(arguments.parts) ? CheckCounts : CheckParts;
  const MergeReport report = check(arguments.parts, arguments.options);
  for (const std::string& part : report.unreadable) PrintMessage("{}\n", part);
  if (report.num_missing == 0) {
    PrintMessage("{} trials, none is missing\n", report.num_trials);
    PrintResult(MakeMergeResult(arguments, report, ""), arguments.format);
    if (report.unreadable.empty()) return;
    throw InputError("the parts above cannot be merged; the other parts have all trials");
  }
  PrintMessage("{}\n", DescribeMissing(report));
  const std::string shards = report.num_shards > 1 ? ArrayText(report.missing_shards) + "\n" : "";
  PrintResult(MakeMergeResult(arguments, report, shards), arguments.format);
  throw EndWith{kTryAgain};
}

// Joins parts of a command other than `rcme run` (core/work/part_file.h). Only that command can tell which
// items of its work are missing.
void JoinTheParts(const MergeArguments& arguments) {
  if (!arguments.is_partial) {
    throw InputError(
        "these are parts of `rcme audit`, `tune`, `transfer` or `map`: merge them with --merge of the same "
        "command, "
        "or join several into one part with --partial");
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
    PrintMessage("{}; nothing was written (--partial writes the trials that there are)\n",
                 DescribeMissing(report));
    throw EndWith{kTryAgain};
  }
  PrintMessage("{} parts, {} trials{} -> {}; next: rcme summarize {}\n", arguments.parts.size(),
               report.num_trials,
               report.num_twice > 0 ? fmt::format(" ({} read twice, and equal)", report.num_twice) : "",
               arguments.out, QuoteForShell(arguments.out));
  if (report.num_missing > 0) PrintMessage("{}\n", DescribeMissing(report));
  PrintResult(MakeMergeResult(arguments, report, ""), arguments.format);
}

}  // namespace

void AddMergeCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("merge", "Merge result files of shards or runs of a study into one");
  command->footer(R"(The merged file gives the bytes of a single run in `rcme summarize`, for any number,
order and grouping of the parts. Parts of another study, option, seed, program or
instruction set are refused, with the difference. So is a trial that differs between
two parts. The file is written whole or not at all, and only if no trial is missing.
Otherwise the exit code is 75 (try again), also with --check.

Examples:
  rcme merge parts/*.sqlite --out run.sqlite
  sbatch --array=$(rcme merge parts/*.sqlite --check) job.sh   run missing shards again
  rcme merge parts/1*.sqlite --partial --out some.sqlite       merge a group first)");
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
              "write nothing; print the missing or incomplete shards as tasks of a Slurm array (3,17-19)")
          ->excludes(out);
  command
      ->add_flag("--partial", arguments->is_partial,
                 "write the trials that there are, even if some are missing")
      ->excludes(check);
  AddFormatOption(command, &arguments->format);
  command->add_flag("--mixed-instruction-sets", arguments->options.are_instruction_sets_mixed,
                    "accept parts of different instruction sets, whose numbers may differ in the last bits");
  command->callback([arguments] {
    const bool are_parts = std::ranges::any_of(arguments->parts, IsPart);
    if (arguments->is_check && !are_parts) return CheckMissing(*arguments);
    if (arguments->out.empty() && !arguments->is_check)
      throw InputError("--out: give the path of the merged file, or --check");
    are_parts ? JoinTheParts(*arguments) : MergeResultFiles(*arguments);
  });
}

}  // namespace rcme
