#include <fmt/format.h>

#include <memory>

#include "experiments/statistics/comparison_output.h"
#include "experiments/core/files/file_output.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/number_option.h"
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
  CLI::App* command = app.add_subcommand(
      "compare", "Each estimator against one of them, on the same trials: does it fail more often?");
  command->footer(
      "All estimators of a study see the same problems, so a trial is a pair. For the events failure,\n"
      "refusal and failure_or_refusal, in every condition: in how many trials it happened to both, to one\n"
      "only, to neither; the difference of the rates with Tango's 95 % interval, as a rule narrower than "
      "the\n"
      "intervals of the two rates suggest, because hard trials are hard for both; and McNemar's exact\n"
      "p-value. Where nothing differs, up to one in twenty of these is still below 0.05: claim a difference\n"
      "by Holm's p-value, which is adjusted for all tests of the comparison: everything compared, every\n"
      "estimator and condition that has trials.\n"
      "\n"
      "--of scores compares means (auc_5_deg, ..., maa_10_deg: `rcme list quantities`), --of errors the\n"
      "error of each trial (the median of the differences, and the sign test); names, or several of all\n"
      "these with commas, choose. What is not asked for costs the others nothing.\n"
      "\n"
      "Scores have intervals and p-values that hold for any law of the scores and at every look. A run of\n"
      "--until stopped by what it saw: its events have such ones too (a confidence sequence of the\n"
      "discordant trials), and its errors the sign test in this way. --anytime asks for the same where\n"
      "trials were added by hand until something was seen.\n"
      "\n"
      "Examples:\n"
      "  rcme compare run.sqlite                                    against the study's first estimator\n"
      "  rcme compare run.sqlite --against rcme_rank_aware          against another\n"
      "  rcme compare run.sqlite --of auc_10_deg,failure            one score and one event\n"
      "  rcme compare run.sqlite --format csv --out comparison.csv\n"
      "  rcme plot paired_difference comparison.csv --x outlier_ratio --out difference");
  auto arguments = std::make_shared<CompareArguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  command->add_option("--against", arguments->against,
                      "label of the reference estimator; default: the first of the study");
  command
      ->add_option("--of", arguments->options.compared,
                   "events, scores, errors, or names of some, with commas between them")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  command->add_flag("--pooled", arguments->is_pooled,
                    "all conditions as one, every pair with the same weight");
  command->add_flag("--anytime", arguments->options.is_anytime_valid,
                    "intervals and p-values that hold however often somebody has looked");
  command->add_option("--format", arguments->format, "table (for people), csv or json (for programs)")
      ->check(OneOf({"table", "csv", "json"}))
      ->capture_default_str();
  command->add_option("-o,--out", arguments->out, "write here instead of standard output");
  command->callback([arguments] {
    if (arguments->is_pooled) arguments->options.pooling = Pooling::kPooled;
    RunCompare(*arguments);
  });
}

}  // namespace rcme
