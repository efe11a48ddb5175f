#include <fmt/format.h>

#include <algorithm>

#include "experiments/commands/commands.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/plot_options.h"
#include "experiments/core/text/columns.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

struct Kind {
  std::string name, input, doc;
};

const std::vector<Kind>& Kinds() {
  static const std::vector<Kind> kinds = {
      {"failure_rate", "SUMMARY.csv",
       "rates, scores or errors over one factor, from `rcme summarize --format csv`"},
      {"heat_map", "SUMMARY.csv", "rates over two factors, from `rcme summarize --format csv`"},
      {"paired_difference", "COMPARISON.csv",
       "differences from a reference, from `rcme compare --format csv`"},
      {"time_against_success", "SUMMARY.csv ...",
       "success over the time of a call, from `rcme summarize --pooled --times`"},
      {"reliability", "RELIABILITY.json",
       "stated probabilities of failure and what happened, from `rcme reliability`"},
      {"stanford", "INTEGRITY.json", "protection levels against errors, from `rcme integrity`"},
      {"gate", "GATE.json", "changes against their margins, from `rcme gate`"},
      {"conform", "REPORT.json", "coverage and size of regions, from `rcme conform --format json`"},
      {"tune", "TUNE.json", "the figures of `rcme tune --figures`"},
      {"transfer", "TRANSFER.json", "the figures of `rcme transfer`"},
      {"crossings", "CROSSINGS.json", "where a rate crosses a value, over a factor, from `rcme solve --out`"},
      {"audit", "FOLDER", "the figures of `rcme audit`"},
      {"validity_map", "FOLDER", "where first-order covariances hold, from `rcme map`"},
      {"validation", "VALIDATION.json", "the figure of `rcme validate`"},
      {"closure", "CLOSURE.csv ...", "closure by the length of loops, from `rcme validate --loops`"},
      {"audit_power", "POWER.csv", "how often the audit detects a wrong sigma"},
      {"benchmarks", "BENCHMARKS.json", "times of `scripts/benchmark`"}};
  return kinds;
}

// `words`: the kind and the arguments of its script, which knows its own options.
void RunPlot(const std::vector<std::string>& words) {
  const auto kind = words.empty() ? Kinds().end() : std::ranges::find(Kinds(), words.front(), &Kind::name);
  if (kind == Kinds().end()) {
    const std::vector<std::string> names = PlotKinds();
    throw InputError(fmt::format(
        "plot: {}; give one of: {}",
        words.empty() ? "which kind of figure?"
                      : Quoted(words.front()) + " is no kind of figure" + DidYouMean(words.front(), names),
        fmt::join(names, ", ")));
  }
  const ScriptEnd end = RunPlotScript(kind->name, {words.begin() + 1, words.end()}, ScriptOutput::kShown);
  if (end == ScriptEnd::kNoPython) ThrowNoPython("plot");
  if (end == ScriptEnd::kFailed) throw EndWith{2};
}

}  // namespace

std::vector<std::string> PlotKinds() { return ListNames(Kinds()); }

const std::vector<PlotOption>& PlotOptions() {
  static const std::vector<PlotOption> options = {
      {"--x", "factor of the horizontal axis"},
      {"--y", "factor of the vertical axis"},
      {"--quantities", "quantities to draw"},
      {"--estimators", "labels of the estimators to draw"},
      {"--event", "event of a comparison"},
      {"--group", "level of the factor of rcme reliability --by"},
      {"--level", "promised coverage of a table of regions"},
      {"--where", "level of another factor, name=level"},
      {"--log-y", "logarithmic vertical axis", /*takes_value=*/false},
      {"--linear-y", "linear vertical axis", /*takes_value=*/false},
      {"--floor", "where a logarithmic axis of rates ends"},
      {"--names", "estimators whose names are written"},
      {"--page", "all figures on one page", /*takes_value=*/false},
      {"--width", "width in inches"},
      {"--labels", "what is printed for a name, name=text"},
      {"--highlight", "labels of the estimators in colour, the others grey"},
      {"--style", "settings for all figures of a paper (TOML)"},
      {"--no-caption", "without the caption", /*takes_value=*/false},
      {"--format", "formats of the files", true, {"png", "pdf", "svg", "tikz"}},
      {"--out", "figure to write, without suffix"}};
  return options;
}

void AddPlotCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "plot", "Draw a figure from a table, as PNG, PDF, SVG or TikZ: rcme plot KIND FILE [OPTIONS]");
  std::string kinds;
  for (const Kind& kind : Kinds()) {
    std::string head = fmt::format("  {:<20} {:<16}", kind.name, kind.input);
    for (const std::string& line : BreakLines(kind.doc, kTextWidth - 40)) {
      kinds += fmt::format("{:<39} {}\n", head, line);
      head.clear();
    }
  }
  command->footer("Kinds, their input, and what they show:\n" + kinds + R"(
Every kind takes --width INCHES (a column of IEEEtran: 3.48, of article: 3.17; text of 7 to 9 points),
--labels NAME=TEXT, --highlight A,B (the others grey), --no-caption, --format png,pdf,svg,tikz, and
--style FILE.toml with these settings for all figures of a paper.

Examples:
  rcme plot failure_rate --help                      the options of that kind
  rcme summarize run.sqlite --format csv --out summary.csv
  rcme plot failure_rate summary.csv --x outlier_ratio --out figure
  rcme plot failure_rate summary.csv --x outlier_ratio --out figure --width 3.17 --format tikz)");
  command->prefix_command();
  command->callback([command] { RunPlot(command->remaining()); });
}

}  // namespace rcme
