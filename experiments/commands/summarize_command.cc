#include <fmt/format.h>

#include <memory>
#include <utility>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/text/key_value.h"
#include "experiments/core/text/message.h"
#include "experiments/statistics/coverage_strata_output.h"
#include "experiments/statistics/forecast_output.h"
#include "experiments/statistics/quantity_table.h"
#include "experiments/statistics/summarize_counts.h"
#include "experiments/statistics/summary_latex.h"
#include "experiments/statistics/summary_output.h"
#include "experiments/statistics/trial_table.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

void WriteTrials(const ResultStore& store, bool with_times, const std::string& out) {
  FileInPieces file(out);
  WriteTrialTable(store, with_times, [&](const std::string& text) { file.Write(text); });
  file.Finish();
}

// The tables for people. If there are failure probabilities, a table of them for all conditions together
// follows.
std::string Tables(const ResultStore& store, const Summary& summary) {
  const std::string text = SummaryAsTable(summary);
  return HasFailureProbabilities(summary) ? text + "\n" + ForecastsAsTable(MeasureFailureForecasts(store))
                                          : text;
}

struct Arguments {
  std::string run, format = "table", raw, fifths_of, by, out;
  std::vector<std::string> quantities;  // empty: the usual ones of the format
  std::vector<std::string> labels;      // of a table for a paper
  bool with_times = false, is_pooled = false, is_by_strata = false;
};

void PrintStrata(const Arguments& arguments) {
  if (KeepsCounts(arguments.run))
    throw InputError(arguments.run + ": --by-strata needs all trials, not counts (rcme run --keep all)");
  const ResultStore store = ResultStore::OpenForReading(arguments.run);
  PrintResult(MakeStrataResult(store.Description().study, MeasureCoverageStrata(store)), arguments.format,
              arguments.out);
}

// Parses NAME=TEXT each; the text may contain any characters.
Settings ParseLabels(const std::vector<std::string>& texts) {
  Settings labels;
  for (const std::string& text : texts) {
    const auto [name, label, has_equals] = SplitKeyValue(text);
    if (name.empty() || !has_equals)
      throw InputError(fmt::format("--labels: {} is not allowed; give name=text", Quoted(text)));
    labels.emplace_back(name, label);
  }
  return labels;
}

void WarnOfRefusals(const Summary& summary) {
  for (const std::string& label : FindAlwaysRefusing(summary)) {
    PrintMessage(
        "warning: {} refused every trial, so no number here describes its motions; "
        "rcme replay RUN --condition 0 --trial 0 shows why\n",
        label);
  }
}

std::string RenderSummary(const Summary& summary, const std::vector<std::string>& quantities,
                          const Arguments& arguments) {
  if (!arguments.labels.empty() && arguments.format != "latex")
    throw InputError("--labels: is for --format latex; other formats keep the names of the study");
  if (arguments.format == "latex") return SummaryAsLatex(summary, quantities, ParseLabels(arguments.labels));
  if (arguments.format == "markdown") return RenderMarkdown(MakeQuantityTable(summary, quantities));
  return quantities.empty() ? SummaryAsTable(summary) : QuantitiesAsTable(summary, quantities);
}

void WriteSummary(Summary summary, const Arguments& arguments) {
  CheckAreQuantities(summary, arguments.quantities);
  const bool is_of_paper = arguments.format == "latex" || arguments.format == "markdown";
  const bool are_usual = is_of_paper && arguments.quantities.empty();
  const std::vector<std::string> quantities =
      AddSharpness(summary, are_usual ? DefaultLatexQuantities() : arguments.quantities);
  const bool is_csv = arguments.format == "csv";
  if (!is_csv && arguments.format != "json")
    return PrintOrWrite(arguments.out, RenderSummary(summary, quantities, arguments));
  if (!quantities.empty()) KeepQuantities(quantities, &summary);
  FileInPieces file(arguments.out);
  (is_csv ? WriteSummaryCsv : WriteSummaryJson)(summary, [&](const std::string& text) { file.Write(text); });
  file.Finish();
}

}  // namespace

void AddSummarizeCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("summarize", "Print rates, scores, medians and means of a run with their intervals");
  command->footer(R"(Beside rates and means the summary has three kinds of scores. The error e of a trial is
the greater of its rotation and direction error.
  AUC at 5, 10, 20 degrees  mean over trials of max(0, 1 - e / T): the exact area under
                            the recall curve up to T
  mAA(10)                   share of trials with an error up to 1, 2, ..., 10 degrees,
                            averaged over these thresholds (as in the image-matching
                            benchmark; others use the name for a mean of AUCs)
  median errors             of rotation, direction and e
Tables of a population show the number of a draw; --format csv has its levels.
A refusal or an invalid answer counts as infinitely wrong. Quantities called _answered
leave out refusals. A direction opposite to the true one is wrong.

--raw writes a row per trial and estimator: the study, the condition, the level of each
factor, the outcome (success, failure, refusal, not_scored), the status (ok, or the reason),
every number of the result file, and the severity of the problem. Its memory does not grow
with the number of trials.

Examples:
  rcme summarize run.sqlite
  rcme summarize run.sqlite --quantities failure,nees_coverage
  rcme summarize run.sqlite --format csv --out summary.csv
  rcme summarize run.sqlite --format latex --quantities failure,nees_coverage \
                 --labels standard=RANSAC
  rcme summarize run.sqlite --fifths-of crb_direction_deg
  rcme summarize run.sqlite --by-strata
  rcme summarize run.sqlite --pooled --by opencv_magsac.threshold_sigma --format csv
  rcme summarize run.sqlite --raw csv --out trials.csv)");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  CLI::Option* format = AddFormatOption(command, &arguments->format);
  command
      ->add_option(
          "--quantities", arguments->quantities,
          "a,b,...: these alone (rcme list quantities), nees_coverage with how sharp the covariances "
          "are; default: the main ones in a table, all in csv and json")
      ->delimiter(',');
  command
      ->add_option("--labels", arguments->labels,
                   "name=text, repeatable: what --format latex prints for an estimator, factor or quantity")
      ->allow_extra_args(false)
      ->needs(format);
  command->add_option("--raw", arguments->raw, "csv: a row per trial and estimator, nothing summarized")
      ->check(MakeChoiceValidator({"csv"}))
      ->excludes(format);
  command->add_option("-o,--out", arguments->out, "write here instead of standard output");
  command->add_flag("--times", arguments->with_times,
                    "add the time per call; without it equal studies give equal bytes");
  command
      ->add_flag(
          "--pooled", arguments->is_pooled,
          "all conditions together, every trial with the same weight; intervals are for the population "
          "where the conditions are draws of one, else for these very conditions")
      ->excludes("--raw");
  command
      ->add_option(
          "--by", arguments->by,
          "FACTOR: with --pooled, once for each of its levels, such as a threshold over a population")
      ->needs("--pooled");
  command
      ->add_option("--fifths-of", arguments->fifths_of,
                   "five groups of equally many trials instead of the conditions, ordered by this quantity "
                   "of the problem: "
                   "crb_direction_deg, planarity, ... (rcme list quantities)")
      ->excludes("--raw")
      ->excludes("--pooled");
  command
      ->add_flag(
          "--by-strata", arguments->is_by_strata,
          "coverage and sharpness by quarters of what is visible at run time (matches, inliers, stated "
          "sd and probability), over all conditions")
      ->excludes("--raw")
      ->excludes("--pooled")
      ->excludes("--fifths-of")
      ->excludes("--quantities")
      ->excludes("--labels")
      ->excludes("--times");
  command->callback([arguments] {
    if (arguments->is_by_strata) return PrintStrata(*arguments);
    const Pooling pooling = arguments->is_pooled ? Pooling::kPooled : Pooling::kPerCondition;
    if (arguments->raw.empty() && KeepsCounts(arguments->run)) {
      if (!arguments->by.empty())
        throw InputError(arguments->run + ": --by needs all trials, not counts (rcme run --keep all)");
      if (!arguments->fifths_of.empty())
        throw InputError(arguments->run + ": --fifths-of needs all trials, not counts (rcme run --keep all)");
      const RunCounts counts = OpenCounts(arguments->run);
      Summary summary = SummarizeCounts(counts, arguments->with_times, pooling);
      summary.preregistration = DescribePreregistered(counts.run, arguments->run);
      WarnOfRefusals(summary);
      return WriteSummary(std::move(summary), *arguments);
    }
    const ResultStore store = ResultStore::OpenForReading(arguments->run);
    if (!arguments->raw.empty()) return WriteTrials(store, arguments->with_times, arguments->out);
    const auto summarize = [&] {
      if (!arguments->by.empty()) return SummarizeBy(ReadRun(store), arguments->with_times, arguments->by);
      if (arguments->fifths_of.empty()) return Summarize(store, arguments->with_times, pooling);
      return SummarizeFifths(ReadRun(store), arguments->with_times,
                             GroupByFifth(store, arguments->fifths_of));
    };
    Summary summary = summarize();
    summary.preregistration = DecidePreregistered(store, arguments->run);
    WarnOfRefusals(summary);
    if (arguments->format == "table" && arguments->quantities.empty())
      return PrintOrWrite(arguments->out, Tables(store, summary));
    WriteSummary(std::move(summary), *arguments);
  });
}

}  // namespace rcme
