#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "experiments/statistics/forecast_output.h"
#include "experiments/core/files/file_output.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/number_option.h"

namespace rcme {

void AddReliabilityCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "reliability", "Do motions fail as often as their stated probabilities say? From result files");
  command->footer(
      "Of every estimator, over the answers whose truth is known: Brier and logarithmic score with "
      "intervals,\n"
      "their parts (miscalibration, discrimination, uncertainty), expected calibration error, calibration\n"
      "slope and intercept, area under the ROC and the risk-coverage curve, failures among the sure "
      "answers.\n"
      "Where right probabilities would not give 0 either, what they would give stands beside it.\n"
      "\n"
      "An estimator that states no probability is given one: its share of inliers, recalibrated by isotonic\n"
      "regression on the other half of the scenes of the run.\n"
      "\n"
      "Examples:\n"
      "  rcme reliability run.sqlite\n"
      "  rcme reliability run.sqlite --by outlier_ratio\n"
      "  rcme reliability indoor.sqlite outdoor.sqlite\n"
      "  rcme reliability run.sqlite --format json --out reliability.json\n"
      "  rcme plot reliability reliability.json --out figure");
  struct Arguments {
    std::vector<std::string> runs;
    std::string by, format = "table", out;
  };
  auto arguments = std::make_shared<Arguments>();
  command->add_option("runs", arguments->runs, "result files of `rcme run`; of several all trials together")
      ->required();
  command->add_option("--by", arguments->by,
                      "a factor of the study: one line per level, not one for all trials");
  command->add_option("--format", arguments->format, "table (for people) or json (for programs and figures)")
      ->check(OneOf({"table", "json"}))
      ->capture_default_str();
  command->add_option("-o,--out", arguments->out, "write here instead of standard output");
  command->callback([arguments] {
    std::vector<ResultStore> runs;
    std::vector<std::string> studies;
    for (const std::string& path : arguments->runs) {
      runs.push_back(ResultStore::OpenForReading(path));
      studies.push_back(runs.back().Description().study);
    }
    const std::vector<ForecastMeasures> measures = MeasureFailureForecasts(runs, arguments->by);
    PrintOrWrite(arguments->out,
                 arguments->format == "json"
                     ? ForecastsAsJson(fmt::format("{}", fmt::join(studies, ", ")), arguments->by, measures)
                     : ForecastsAsTable(measures, arguments->by));
  });
}

}  // namespace rcme
