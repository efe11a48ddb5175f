#include <fmt/format.h>

#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/statistics/comparison_output.h"
#include "experiments/study/estimator_spec.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct CompareArguments {
  std::string run, other, against, format = "table", out;
  bool is_pooled = false;
  CompareOptions options;
};

// The reference of one result file and all estimators of another.
ReadableRun JoinWithReference(const ResultStore& store, const std::string& reference,
                              const ResultStore& other) {
  const RunDescription run = store.Description();
  const size_t e = reference.empty() ? 0
                                     : FindEstimator(run.estimators, reference,
                                                     fmt::format("--against: study '{}'", run.study));
  std::vector<size_t> of_other(other.Description().estimators.size());
  std::iota(of_other.begin(), of_other.end(), size_t{0});
  return JoinRuns(store, {e}, other, of_other);
}

void RunCompare(const CompareArguments& arguments) {
  const ResultStore store = ResultStore::OpenForReading(arguments.run);
  std::optional<ResultStore> other;
  if (!arguments.other.empty()) other.emplace(ResultStore::OpenForReading(arguments.other));
  const ReadableRun run = other ? JoinWithReference(store, arguments.against, *other) : ReadRun(store);
  const Comparison comparison = Compare(run, other ? "" : arguments.against, arguments.options);
  if (comparison.rows.empty() && run.description.estimators.size() == 1) {
    throw InputError(fmt::format("{}: study '{}' has one estimator, '{}'; a comparison needs two",
                                 arguments.run, comparison.study, comparison.reference));
  }
  if (comparison.rows.empty()) throw InputError(fmt::format("{}: {}", arguments.run, comparison.caution));
  PrintResult(MakeComparisonResult(comparison), arguments.format, arguments.out);
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
are hard for both. An event that happened to no estimator has no table. Without any
difference up to one p-value in twenty is still below 0.05, so judge by Holm's p-value:
it is adjusted for all tests of the comparison.

--of scores compares mean scores (auc_5_deg, ..., maa_10_deg: `rcme list quantities`),
--of errors the errors of each trial (median difference and sign test). You can also
give names, separated by commas. Only what you ask for enters Holm's adjustment.

Scores have intervals and p-values that are valid for any distribution and at every
look. After `rcme run --until`, which stops by what it saw, events and errors have such
intervals and p-values too (from the sequence of discordant trials). Use --anytime if
you added trials by hand until you saw a difference.

With a second result file, of the same study with other estimators or by another version
of the program, its estimators are compared with one of the first file. Trials are paired
by condition and number, and their problems must be the same.

Examples:
  rcme compare run.sqlite                                 against the first estimator
  rcme compare before.sqlite after.sqlite                 against that of another file
  rcme compare run.sqlite --against rcme_rank_aware       against another
  rcme compare run.sqlite --of auc_10_deg,failure         one score and one event
  rcme compare run.sqlite --format csv --out comparison.csv
  rcme plot paired_difference comparison.csv --x outlier_ratio --out difference)");
  auto arguments = std::make_shared<CompareArguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  command->add_option("other", arguments->other,
                      "another result file, whose estimators are compared with one of the first file");
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
  AddFormatOption(command, &arguments->format);
  command->add_option("-o,--out", arguments->out, "write here instead of standard output");
  command->callback([arguments] {
    if (arguments->is_pooled) arguments->options.pooling = Pooling::kPooled;
    RunCompare(*arguments);
  });
}

}  // namespace rcme
