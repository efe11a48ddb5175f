#include <fmt/format.h>

#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/number_option.h"
#include "experiments/core/files/file_output.h"
#include "experiments/statistics/comparison_output.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct CompareArguments {
  std::string run, against, format = "table", out;
  bool is_pooled = false;
  CompareOptions options;
};

void RunCompare(const CompareArguments& arguments) {
  const ResultStore store = ResultStore::OpenForReading(arguments.run);
  const Comparison comparison = Compare(store, arguments.against, arguments.options);
  if (comparison.rows.empty() && store.Description().estimators.size() == 1) {
    throw InputError(fmt::format("{}: study '{}' has one estimator, '{}'; a comparison needs two",
                                 arguments.run, comparison.study, comparison.reference));
  }
  if (comparison.rows.empty()) throw InputError(fmt::format("{}: {}", arguments.run, comparison.caution));
  PrintOrWrite(arguments.out, arguments.format == "csv"    ? ComparisonAsCsv(comparison)
                              : arguments.format == "json" ? ComparisonAsJson(comparison)
                                                           : ComparisonAsTable(comparison));
}

}  // namespace

void AddCompareCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("compare", "Compare each estimator with a reference on the same trials");
  command->footer(R"(All estimators of a study solve the same problems, so every trial is a pair. For the
events failure, refusal and failure_or_refusal the table has, in each condition, the
trials in which the event happened to both estimators, to one, or to none; the
difference of the rates with Tango's 95 % interval; and McNemar's exact p-value. The
interval is usually narrower than those of the two rates suggest, because hard trials
are hard for both. Without any difference up to one p-value in twenty is still below
0.05, so judge by Holm's p-value: it is adjusted for all tests of the comparison.

--of scores compares mean scores (auc_5_deg, ..., maa_10_deg: `rcme list quantities`),
--of errors the errors of each trial (median difference and sign test). You can also
give names, separated by commas. Only what you ask for enters Holm's adjustment.

Scores have intervals and p-values that are valid for any distribution and at every
look. After `rcme run --until`, which stops by what it saw, events and errors have such
intervals and p-values too (from the sequence of discordant trials). Use --anytime if
you added trials by hand until you saw a difference.

Examples:
  rcme compare run.sqlite                                 against the first estimator
  rcme compare run.sqlite --against rcme_rank_aware       against another
  rcme compare run.sqlite --of auc_10_deg,failure         one score and one event
  rcme compare run.sqlite --format csv --out comparison.csv
  rcme plot paired_difference comparison.csv --x outlier_ratio --out difference)");
  auto arguments = std::make_shared<CompareArguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  command->add_option("--against", arguments->against,
                      "label of the reference estimator; default: the study's first");
  command
      ->add_option("--of", arguments->options.compared,
                   "events, scores, errors, or single names, separated by commas")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  command->add_flag("--pooled", arguments->is_pooled,
                    "all conditions together, every trial with the same weight; intervals are for the "
                    "population where the conditions are draws of one, else for these very conditions");
  command->add_flag("--anytime", arguments->options.is_anytime_valid,
                    "intervals and p-values that stay valid however often you look");
  command->add_option("--format", arguments->format, "table (for people), csv or json (for programs)")
      ->check(IsOneOf({"table", "csv", "json"}))
      ->capture_default_str();
  command->add_option("-o,--out", arguments->out, "write here instead of standard output");
  command->callback([arguments] {
    if (arguments->is_pooled) arguments->options.pooling = Pooling::kPooled;
    RunCompare(*arguments);
  });
}

}  // namespace rcme
