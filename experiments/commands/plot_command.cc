#include <fmt/format.h>

#include <algorithm>

#include "experiments/commands/commands.h"
#include "experiments/commands/draw_figures.h"
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
      {"failure_rate", "SUMMARY.csv", "rates against one factor, of `rcme summarize --format csv`"},
      {"heat_map", "SUMMARY.csv", "rates over two factors, of `rcme summarize --format csv`"},
      {"paired_difference", "COMPARISON.csv", "differences to a reference, of `rcme compare --format csv`"},
      {"time_against_success", "SUMMARY.csv ...",
       "success against the time of a call, of `rcme summarize --pooled --times`"},
      {"reliability", "RELIABILITY.json",
       "stated probabilities of failure against what happened, of `rcme reliability`"},
      {"tune", "TUNE.json", "what `rcme tune --figures` draws, again"},
      {"transfer", "TRANSFER.json", "what `rcme transfer` draws, again"},
      {"audit", "FOLDER", "what `rcme audit` draws, again"},
      {"validity_map", "FOLDER", "where first-order covariances hold, of `rcme map`"},
      {"validation", "VALIDATION.json", "what `rcme validate` draws, again"},
      {"audit_power", "POWER.csv", "how often the audit notices a wrong sigma"},
      {"benchmarks", "BENCHMARKS.json", "times of `scripts/benchmark`"}};
  return kinds;
}

// `words`: the kind and the arguments of its script, which knows its own options.
void RunPlot(const std::vector<std::string>& words) {
  const auto kind = words.empty() ? Kinds().end() : std::ranges::find(Kinds(), words.front(), &Kind::name);
  if (kind == Kinds().end()) {
    std::vector<std::string> names;
    for (const Kind& known : Kinds()) names.push_back(known.name);
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

void AddPlotCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "plot", "Draw a figure of a table, PNG, PDF, SVG or TikZ: rcme plot KIND FILE [OPTIONS of that kind]");
  std::string kinds;
  for (const Kind& kind : Kinds())
    kinds += fmt::format("  {:<18} {:<16} {}\n", kind.name, kind.input, kind.doc);
  command->footer(
      "Kinds, what they draw from, and what it is:\n" + kinds +
      "\n"
      "Every kind takes --width INCHES (3.3: a column; texts of 7 to 9 points), --labels NAME=TEXT, "
      "--no-caption\n"
      "and --format png,pdf,svg,tikz.\n"
      "\n"
      "Examples:\n"
      "  rcme plot failure_rate --help                      the options of that kind\n"
      "  rcme summarize run.sqlite --format csv --out summary.csv\n"
      "  rcme plot failure_rate summary.csv --x outlier_ratio --out figure\n"
      "  rcme plot failure_rate summary.csv --x outlier_ratio --out figure --width 3.3 --format tikz");
  command->prefix_command();
  command->callback([command] { RunPlot(command->remaining()); });
}

}  // namespace rcme
